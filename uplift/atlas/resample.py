"""Entries of any sampling → one array on one wavelength grid."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.checks import Array
from uplift.common.errors import UpliftWarning

NOISE = 1e-6
"""Distance from [0, 1] that is not worth a word: sensors give −2e−16 for black."""


@dataclass(frozen=True)
class Clip:
    """An entry that leaves [0, 1], with the value that leaves it farthest and its wavelength in nm."""

    name: str
    value: float
    wavelength: float

    def __str__(self) -> str:
        return f"{self.value:.6g} at {self.wavelength:g} nm clipped to {min(max(self.value, 0), 1):g}"


@dataclass(frozen=True, eq=False)
class Resampled:
    """(E, N) reflectances within [0, 1], and who had to be clipped for that."""

    values: Array
    clips: tuple[Clip, ...]


def on_grid(spectra: Atlas, wavelengths: ArrayLike) -> Array:
    """Reflectances of all entries (E, N) at wavelengths (N,) nm, within [0, 1].

    Shape-preserving cubic (PCHIP, so no overshoot) inside the measured range, held flat outside it. An
    `UpliftWarning` names every entry whose values had to be clipped by more than noise.
    """
    resampled = resample(spectra, wavelengths)
    for clip in resampled.clips:
        warnings.warn(f"entry '{clip.name}': {clip}", UpliftWarning, stacklevel=2)
    return resampled.values


def resample(spectra: Atlas, wavelengths: ArrayLike) -> Resampled:
    """What `on_grid` gives, with the clipping as data in place of warnings."""
    grid = np.asarray(wavelengths, dtype=np.float64)
    raw = np.array([_interpolate(entry, grid) for entry in spectra.entries]).reshape(-1, len(grid))
    clips = [_clip(entry.name, row, grid) for entry, row in zip(spectra.entries, raw, strict=True)]
    return Resampled(np.clip(raw, 0.0, 1.0), tuple(clip for clip in clips if clip is not None))


def _interpolate(entry: Entry, grid: Array) -> Array:
    from scipy.interpolate import PchipInterpolator

    with np.errstate(over="ignore"):  # slopes near 0 go through their reciprocals
        curve = PchipInterpolator(entry.wavelengths, entry.values)
    return np.asarray(curve(np.clip(grid, entry.wavelengths[0], entry.wavelengths[-1])), dtype=np.float64)


def _clip(name: str, row: Array, grid: Array) -> Clip | None:
    excess = np.maximum(row - 1.0, -row)
    if not np.any(excess > NOISE):
        return None
    worst = int(excess.argmax())
    return Clip(name, float(row[worst]), float(grid[worst]))
