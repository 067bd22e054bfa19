"""Resampling of entries to one wavelength grid."""

import warnings
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.text import listed, pluralise

NOISE = 1e-6
"""Distance from [0, 1] that is clipped without a warning, such as −2e−16 for black."""


@dataclass(frozen=True)
class Clip:
    """The value of an entry farthest outside [0, 1].

    Parameters
    ----------
    name : str
        Name of the entry.
    value : float
        The value before clipping.
    wavelength : float
        Its wavelength in nm.
    """

    name: str
    value: float
    wavelength: float

    def __str__(self) -> str:
        return f"{self.value:.6g} at {self.wavelength:g} nm clipped to {min(max(self.value, 0), 1):g}"


@dataclass(frozen=True, eq=False)
class Resampled:
    """Reflectances on a grid, and the entries that were clipped.

    Parameters
    ----------
    values : ndarray, shape (E, N)
        Reflectances in [0, 1].
    clips : tuple of Clip
        One for every entry that was clipped by more than noise.
    """

    values: Array
    clips: tuple[Clip, ...]


def on_grid(atlas: Atlas, wavelengths: ArrayLike) -> Array:
    """Resample all entries to a wavelength grid.

    The interpolation is a shape-preserving cubic (PCHIP) without overshoot, with constant extrapolation.

    Parameters
    ----------
    atlas : Atlas
        E entries.
    wavelengths : array_like, shape (N,)
        Wavelengths in nm.

    Returns
    -------
    ndarray, shape (E, N)
        Reflectances in [0, 1].

    Warns
    -----
    UpliftWarning
        Entries were clipped by more than noise (``entry-clipped``).

    References
    ----------
    Fritsch & Carlson 1980, "Monotone piecewise cubic interpolation".

    Examples
    --------
    >>> from uplift.atlas import Entry
    >>> atlas = Atlas((Entry("ramp", [400, 700], [0.25, 0.75]),))
    >>> on_grid(atlas, [380, 400, 550, 700]).tolist()
    [[0.25, 0.25, 0.5, 0.75]]
    """
    resampled = resample(atlas, wavelengths)
    clips = resampled.clips
    if len(clips) == 1:
        warnings.warn(UpliftWarning(str(clips[0]), code="entry-clipped", entry=clips[0].name), stacklevel=2)
    elif clips:
        names = listed([f"'{clip.name}'" for clip in clips])
        most = max(clips, key=lambda clip: max(-clip.value, clip.value - 1))
        problem = f"{pluralise(len(clips), 'entry')} clipped to [0, 1]: {names}; '{most.name}' has {most}"
        warnings.warn(UpliftWarning(problem, code="entry-clipped"), stacklevel=2)
    return resampled.values


def resample(atlas: Atlas, wavelengths: ArrayLike) -> Resampled:
    """Resample all entries as `on_grid`, and return the clipped entries instead of warning.

    Parameters
    ----------
    atlas, wavelengths
        As in `on_grid`.

    Returns
    -------
    Resampled
    """
    grid = np.asarray(wavelengths, dtype=np.float64)
    entries, alike = atlas.entries, defaultdict[bytes, list[int]](list)
    raw = np.empty((len(entries), len(grid)))
    for row, entry in enumerate(entries):
        alike[entry.wavelengths.tobytes()].append(row)
    for rows in alike.values():
        values = np.stack([entries[row].values for row in rows])
        raw[rows] = pchip(entries[rows[0]].wavelengths, values, grid)
    # Distance from [0, 1]: x − 1 above, −x below
    excess = np.maximum(raw - 1.0, -raw)
    clips = []
    for row in np.flatnonzero(excess.max(axis=1, initial=0) > NOISE).tolist():
        worst = int(excess[row].argmax())
        clips.append(Clip(entries[row].name, float(raw[row, worst]), float(grid[worst])))
    return Resampled(np.clip(raw, 0.0, 1.0), tuple(clips))


def pchip(x: Array, y: Array, at: Array) -> Array:
    """Interpolate y (…, n), n ≥ 2, from increasing x (n,) to (…, N) by a monotone cubic that is constant outside.

    That of scipy's ``PchipInterpolator``, whose import takes as long as a small fit. Fritsch & Butland 1984.
    """
    step, place = np.diff(x), np.clip(at, x[0], x[-1])
    rise = np.diff(y) / step
    slope = np.repeat(rise[..., :1], len(x), axis=-1)
    if len(x) > 2:
        # Weighted harmonic means of the slopes of neighbouring intervals, 0 at extremes
        left, right = rise[..., :-1], rise[..., 1:]
        first, second = step[:-1] + 2 * step[1:], 2 * step[:-1] + step[1:]
        with np.errstate(all="ignore"):
            mean = 1 / ((first / left + second / right) / (first + second))
        slope[..., 1:-1] = np.where((np.sign(left) == np.sign(right)) & (left != 0), mean, 0)
        # At the ends that of a parabola through three points, limited to 0 … 3 times that of the interval
        near, other = rise[..., [0, -1]], rise[..., [1, -2]]
        width, far = step[[0, -1]], step[[1, -2]]
        parabola = ((2 * width + far) * near - width * other) / (width + far)
        slope[..., [0, -1]] = np.clip(parabola, np.minimum(0, 3 * near), np.maximum(0, 3 * near))
    row = np.clip(np.searchsorted(x, place, side="right") - 1, 0, len(x) - 2)
    # The cubic of Hermite of each interval
    bend = (slope[..., :-1] + slope[..., 1:] - 2 * rise) / step
    cubic, square = bend / step, (rise - slope[..., :-1]) / step - bend
    t = place - x[row]
    return np.asarray(y[..., row] + slope[..., row] * t + square[..., row] * (t * t) + cubic[..., row] * (t * t * t))
