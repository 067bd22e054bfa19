"""Reproducible synthetic atlases that are difficult to fit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.atlas import LOWEST
from uplift.colorimetry import observer
from uplift.common.arrays import Array

CROWDED_ENTRIES, ENTRIES = 120, 24
"""Numbers of entries of the crowded atlas and of the others."""
NOISE = 0.05
"""Standard deviation of the reflectances of the noisy atlas, as of a poor instrument in a dark room."""
PEAK_HALF_WIDTH = 8.0
"""Half-width in nm of the peaks of the spiky atlas."""
HIGHEST = 1.05
"""Largest reflectance of the noisy atlas."""


def crowded() -> Atlas:
    """Make 120 smooth spectra of one paint, whose colours differ by about 1 ΔE."""
    rng = np.random.default_rng(1)
    slope = np.tanh((observer.grid() - 580) / 60)
    spectra = [0.3 + 0.15 * slope + _smooth_deviation(rng, 0.01) for _ in range(CROWDED_ENTRIES)]
    return _atlas("crowded", spectra)


def spiky() -> Atlas:
    """Make spectra of two narrow peaks on black, or two narrow dips on white, which few moments cannot represent."""
    rng, wavelengths = np.random.default_rng(2), observer.grid()

    def spectrum(dark: bool) -> Array:
        centres = rng.uniform(430, 670, 2)
        peaks = np.exp(-(((wavelengths[:, None] - centres) / PEAK_HALF_WIDTH) ** 2)).max(axis=1)
        return np.asarray(0.02 + 0.93 * peaks if dark else 0.95 - 0.93 * peaks)

    return _atlas("spiky", [spectrum(number % 2 == 0) for number in range(ENTRIES)])


def noisy() -> Atlas:
    """Make smooth spectra with noise that leaves [0, 1] as far as readers allow."""
    rng = np.random.default_rng(3)

    def spectrum(level: float) -> Array:
        noise = rng.normal(0, NOISE, len(observer.grid()))
        return np.clip(level + _smooth_deviation(rng, 0.1) + noise, LOWEST, HIGHEST)

    return _atlas("noisy", [spectrum(level) for level in np.linspace(0.05, 0.95, ENTRIES)])


SYNTHETIC_ATLASES: dict[str, Callable[[], Atlas]] = {"crowded": crowded, "spiky": spiky, "noisy": noisy}
"""Functions that make the atlases, by name."""


def _smooth_deviation(rng: np.random.Generator, amplitude: float) -> Array:
    """Random sum (N,) of the first four cosines over the range."""
    phase = np.linspace(0, np.pi, len(observer.grid()))
    cosines = np.cos(phase[:, None] * np.arange(1, 5))
    return np.asarray(cosines @ rng.normal(0, amplitude, 4))


def _atlas(name: str, spectra: list[Array]) -> Atlas:
    entries = (Entry(f"{name} {number}", observer.grid(), row) for number, row in enumerate(spectra, 1))
    return Atlas(tuple(entries))
