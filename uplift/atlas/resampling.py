"""Resampling of entries to one wavelength grid."""

from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import SLACK, Atlas, Entry
from uplift.common.arrays import Array, blocks
from uplift.common.errors import UpliftWarning, warn
from uplift.common.text import listed, pluralise

WIDEST = 20.0
"""Largest step in nm of a grid whose bands are averaged over."""
BLOCK = 1000
"""Entries that are interpolated at once."""
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
        return (
            f"{self.value:.6g} at {self.wavelength:g} nm clipped to "
            f"{min(max(self.value, 0), 1):g}"
        )


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

    The interpolation is a shape-preserving cubic (PCHIP) without overshoot, with
    constant extrapolation. An entry that is sampled more finely than a regular grid of
    at most 20 nm is averaged over bands as wide as the step (CIE 15:2018, ASTM E308),
    so that the noise of its samples averages out.

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
        warn(UpliftWarning(str(clips[0]), code="entry-clipped", entry=clips[0].name))
    elif clips:
        names = listed([f"'{clip.name}'" for clip in clips])
        most = max(clips, key=lambda clip: max(-clip.value, clip.value - 1))
        problem = (
            f"{pluralise(len(clips), 'entry')} clipped to [0, 1]: {names}; "
            f"'{most.name}' has {most}"
        )
        warn(UpliftWarning(problem, code="entry-clipped"))
    return resampled.values


def resample(atlas: Atlas, wavelengths: ArrayLike) -> Resampled:
    """Resample all entries as `on_grid`, and return the clipped entries instead of
    warning.

    Parameters
    ----------
    atlas, wavelengths
        As in `on_grid`.

    Returns
    -------
    Resampled
    """
    grid = np.asarray(wavelengths, dtype=np.float64)
    entries = atlas.entries
    alike = defaultdict[bytes, list[int]](list)
    raw = np.empty((len(entries), len(grid)))
    for row, entry in enumerate(entries):
        alike[entry.wavelengths.tobytes()].append(row)
    for same in alike.values():
        nm = entries[same[0]].wavelengths
        for block in blocks(len(same), BLOCK):
            rows = same[block]
            values = np.stack([entries[row].values for row in rows])
            raw[rows] = (
                values if np.array_equal(nm, grid) else _interpolate(nm, values, grid)
            )
    clips = [clip for entry in entries if (clip := _clip(entry, grid))]
    return Resampled(np.clip(raw, 0.0, 1.0, out=raw), tuple(clips))


def _clip(entry: Entry, grid: Array) -> Clip | None:
    """Return the sample of an entry within the range of a grid that is farthest outside
    [0, 1].
    """
    if entry.values.min() >= -NOISE and entry.values.max() <= 1 + NOISE:
        return None
    # Distance from [0, 1]: x − 1 above, −x below
    excess = np.maximum(entry.values - 1.0, -entry.values)
    excess[(entry.wavelengths < grid.min()) | (entry.wavelengths > grid.max())] = 0
    worst = int(excess.argmax())
    is_noise = excess[worst] <= NOISE
    return (
        None
        if is_noise
        else Clip(
            entry.name, float(entry.values[worst]), float(entry.wavelengths[worst])
        )
    )


def _step(grid: Array) -> float:
    """Return the step of a regular grid in nm; 0 for wavelengths that do not sample a
    spectrum.
    """
    steps = np.diff(grid)
    is_sampling = len(steps) > 1 and np.ptp(steps) < SLACK and 0 < steps[0] <= WIDEST
    return float(steps[0]) if is_sampling else 0.0


def _interpolate(nm: Array, values: Array, grid: Array) -> Array:
    """Resample values (E, n) at wavelengths (n,) to a grid (N,): averages over its
    bands if they are finer.
    """
    from scipy.interpolate import (
        PchipInterpolator,
    )  # takes as long to import as a small build

    curve = PchipInterpolator(nm, values, axis=1)
    step = _step(grid)
    if step and np.median(np.diff(nm)) < step - SLACK:
        return (
            _integral(curve, grid + step / 2) - _integral(curve, grid - step / 2)
        ) / step
    return curve(np.clip(grid, nm[0], nm[-1]))


def _integral(curve: Any, ends: Array) -> Array:
    """Integrate a `PchipInterpolator` of (E, n) from its first wavelength to ends (N,);
    it is constant outside.
    """
    first, last = curve.x[[0, -1]]
    inside = np.clip(ends, first, last)
    constant = np.where(ends < first, curve(first)[:, None], curve(last)[:, None])
    return curve.antiderivative()(inside) + constant * (ends - inside)
