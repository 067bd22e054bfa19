"""Hero wavelengths (HW): four wavelengths per path, drawn for each path, as renderers do.

Wilkie, Nawaz, Droske, Weidlich & Hanika 2014, "Hero wavelength spectral sampling": a hero, and three more at distances
of a quarter of the range. They follow the density of Radziszewski, Boryczko & Alda 2009, as in pbrt. The heroes of a
pixel are stratified: one in each of as many equal strata as it has paths. A row is a pixel with its own, reproducible
random numbers. Spectra remain tables, evaluated at the wavelengths of a path; the storage is that of the paths.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.observer import END, START
from uplift.common.arrays import Array
from uplift.scene.representations.dense import interp_rows, xyz_weights
from uplift.scene.representations.samples import row_sizes

WAVELENGTHS = 4
"""Wavelengths per path."""
SEED = 7
STEEPNESS, CENTRE = 0.0072, 538.0
"""Parameters of the density 1 / cosh²(0.0072 (λ − 538)), λ in nm."""


class PathSamples(NamedTuple):
    """Values (n, K) at wavelengths (n, K) nm."""

    wavelengths: Array
    values: Array


@dataclass(frozen=True)
class HeroWavelengths:
    """Monte Carlo sampling with ``paths`` per pixel."""

    paths: int
    family = "hero wavelengths"

    @property
    def name(self) -> str:
        return f"HW{WAVELENGTHS * self.paths}"

    def encode_light(self, power: Array) -> PathSamples:
        wavelengths = self.wavelengths(len(power))
        return PathSamples(wavelengths, interp_rows(power, wavelengths))

    def encode_surface(self, reflectance: Array) -> PathSamples:
        return self.encode_light(reflectance)

    def multiply(self, light: PathSamples, surface: PathSamples) -> PathSamples:
        return PathSamples(light.wavelengths, light.values * surface.values)

    def xyz(self, light: PathSamples) -> Array:
        low, high = _cumulative(np.array([START, END]))
        density = STEEPNESS / np.cosh(STEEPNESS * (light.wavelengths - CENTRE)) ** 2 / (high - low)
        estimate = light.values / density
        rows = np.broadcast_to(xyz_weights().T[:, None], (3, len(estimate), len(xyz_weights())))
        weights = [interp_rows(row, light.wavelengths) for row in rows]
        return np.stack([(estimate * weight).mean(axis=1) for weight in weights], axis=1)

    def storage(self, code: PathSamples) -> Array:
        return row_sizes(code.values)

    def wavelengths(self, pixels: int) -> Array:
        """Draw wavelengths (pixels, 4 · paths) in nm."""
        rng = np.random.default_rng(SEED)
        heroes = (np.arange(self.paths) + rng.random((pixels, self.paths))) / self.paths
        rotated = (heroes[:, :, None] + np.arange(WAVELENGTHS) / WAVELENGTHS) % 1
        low, high = _cumulative(np.array([START, END]))
        wavelengths = CENTRE + np.arctanh(low + (high - low) * rotated) / STEEPNESS
        return np.asarray(np.clip(wavelengths, START, END).reshape(pixels, -1))


def _cumulative(wavelengths: Array) -> Array:
    """Antiderivative of the density, not normalised."""
    return np.tanh(STEEPNESS * (wavelengths - CENTRE))
