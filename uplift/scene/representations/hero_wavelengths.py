"""Hero-wavelength sampling (HW) as renderers do it: four wavelengths a path, drawn anew for every path.

Wilkie, Nawaz, Droske, Weidlich & Hanika 2014, "Hero wavelength spectral sampling": a hero, and three a quarter of
the range apart. They are drawn by the density of Radziszewski, Boryczko & Alda 2009, as pbrt does; a pixel's heroes
are stratified, one in each of as many equal strata as it has paths. A row is a pixel with its own random numbers,
the same on every run. Spectra stay tables that are evaluated where a path asks: what is counted as stored is what
the paths carry.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.observer import END, START
from uplift.common.arrays import Array
from uplift.scene.representations.dense import interp_spectra, xyz_weights
from uplift.scene.representations.samples import row_sizes

WAVELENGTHS = 4
SEED = 7
STEEPNESS, CENTRE = 0.0072, 538.0
"""The density is 1 / cosh²(0.0072 (λ − 538)), λ in nm."""


class Carried(NamedTuple):
    """``values`` (n, K) at ``wavelengths`` (n, K) nm."""

    wavelengths: Array
    values: Array


@dataclass(frozen=True)
class HeroWavelengths:
    """``paths`` a pixel."""

    paths: int

    @property
    def name(self) -> str:
        return f"HW{WAVELENGTHS * self.paths}"

    @property
    def family(self) -> str:
        return "hero wavelengths"

    def encode_light(self, power: Array) -> Carried:
        drawn = self.wavelengths(len(power))
        return Carried(drawn, interp_spectra(power, drawn))

    def encode_surface(self, reflectance: Array) -> Carried:
        return self.encode_light(reflectance)

    def multiply(self, light: Carried, surface: Carried) -> Carried:
        return Carried(light.wavelengths, light.values * surface.values)

    def xyz(self, light: Carried) -> Array:
        low, high = _share(np.array([START, END]))
        density = STEEPNESS / np.cosh(STEEPNESS * (light.wavelengths - CENTRE)) ** 2 / (high - low)
        weighed = light.values / density
        rows = np.broadcast_to(xyz_weights().T[:, None], (3, len(weighed), len(xyz_weights())))
        seen = [interp_spectra(row, light.wavelengths) for row in rows]
        return np.stack([(weighed * one).mean(axis=1) for one in seen], axis=1)

    def storage(self, code: Carried) -> Array:
        return row_sizes(code.values)

    def wavelengths(self, pixels: int) -> Array:
        """(pixels, 4 · paths) nm."""
        heroes = (
            np.arange(self.paths) + np.random.default_rng(SEED).random((pixels, self.paths))
        ) / self.paths
        turned = (heroes[:, :, None] + np.arange(WAVELENGTHS) / WAVELENGTHS) % 1
        low, high = _share(np.array([START, END]))
        drawn = CENTRE + np.arctanh(low + (high - low) * turned) / STEEPNESS
        return np.asarray(np.clip(drawn, START, END).reshape(pixels, -1))


def _share(wavelengths: Array) -> Array:
    """Antiderivative of the density, not normalised."""
    return np.tanh(STEEPNESS * (wavelengths - CENTRE))
