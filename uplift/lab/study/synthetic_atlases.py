"""Atlases that are hard on purpose, made from seed numbers: always the same."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.checks import LOWEST
from uplift.colorimetry import observer
from uplift.common.arrays import Array

CROWD, FEW = 120, 24
NOISE = 0.05
"""Standard deviation of the noisy atlas, in units of reflectance: of a poor instrument in a dark room."""
PEAK = 8.0
"""Half-width (nm) of the peaks of the spiky atlas."""


def crowded() -> Atlas:
    """One paint mixed over and over: the colours of 120 smooth spectra lie within some ΔE of one another."""
    rng = np.random.default_rng(1)
    slope = np.tanh((observer.grid() - 580) / 60)
    return _named("crowded", [0.3 + 0.15 * slope + _smooth(rng, 0.01) for _ in range(CROWD)])


def spiky() -> Atlas:
    """Two narrow peaks on black, or two narrow lines on white, as no paint has and no few moments hold."""
    rng, wavelengths = np.random.default_rng(2), observer.grid()

    def one(dark: bool) -> Array:
        middles = rng.uniform(430, 670, 2)
        peaks = np.exp(-(((wavelengths[:, None] - middles) / PEAK) ** 2)).max(axis=1)
        return np.asarray(0.02 + 0.93 * peaks if dark else 0.95 - 0.93 * peaks)

    return _named("spiky", [one(number % 2 == 0) for number in range(FEW)])


def noisy() -> Atlas:
    """Smooth spectra, and noise at every wavelength that takes some of them as far out of [0, 1] as readers allow."""
    rng = np.random.default_rng(3)

    def one(level: float) -> Array:
        noise = rng.normal(0, NOISE, len(observer.grid()))
        return np.clip(level + _smooth(rng, 0.1) + noise, LOWEST, 1.05)

    return _named("noisy", [one(level) for level in np.linspace(0.05, 0.95, FEW)])


SYNTHETIC_ATLASES: dict[str, Callable[[], Atlas]] = {"crowded": crowded, "spiky": spiky, "noisy": noisy}


def _smooth(rng: np.random.Generator, amplitude: float) -> Array:
    """(N,) a random sum of the first few waves over the range."""
    phase = np.linspace(0, np.pi, len(observer.grid()))
    waves = np.cos(phase[:, None] * np.arange(1, 5))
    return np.asarray(waves @ rng.normal(0, amplitude, 4))


def _named(name: str, spectra: list[Array]) -> Atlas:
    return Atlas(
        tuple(Entry(f"{name} {number}", observer.grid(), row) for number, row in enumerate(spectra, 1))
    )
