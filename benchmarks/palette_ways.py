"""Ways of light over the shipped atlases, one to four reflections, and their colours by every kind of product."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.timing import ROOT
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.palette import FactorModel, LinearModel
from uplift.design.palette.colours import exposure, screen_matrix
from uplift.design.palette.lights import illuminant

LIGHTS = ("D65", "D50", "A", "E", "FL2", "FL7", "FL11", "LED-B3", "HP1")
BOUNCES = (1, 2, 3, 4)
DRAWN = 2000
"""Ways of two and more reflections; of one, every material."""

Product = Callable[[Array, Array], Array]
"""A power (N,) and the reflectances (n, k, N) that it meets → linear RGB (n, 3)."""


@dataclass(frozen=True, eq=False)
class Ways:
    """``powers`` (L, N) of the lights, and for every number of reflections the reflectances (n, k, N) met."""

    sensor: Sensor
    powers: dict[str, Array]
    met: dict[int, Array]

    def errors(self, product: Product, light: str, bounces: int) -> Array:
        """ΔE00 (n) of a product's colours against those of whole spectra, both exposed to mid-grey."""
        power, met = self.powers[light], self.met[bounces]
        full = (power * met.prod(axis=1)) @ screen_matrix(self.sensor).T
        gain = exposure(self.sensor, full)[:, None]
        return delta_e_rgb(self.sensor, gain * full, gain * product(power, met))


def ways(sensor: Sensor) -> Ways:
    atlases = read_atlas(*sorted((ROOT / "atlases").glob("*.txt")))
    materials = on_grid(atlases, sensor.wavelengths)
    draw = np.random.default_rng(2004)
    rows = {k: draw.integers(0, len(materials), (DRAWN, k)) for k in BOUNCES[1:]}
    met = {1: materials[:, None]} | {k: materials[row] for k, row in rows.items()}
    return Ways(sensor, {name: illuminant(sensor, name) for name in LIGHTS}, met)


def by_rgb(sensor: Sensor) -> Product:
    """RGB products, each surface's RGB being that under a flat white (Bergner, eq. 9–12)."""
    screen = screen_matrix(sensor)
    white = screen.sum(axis=1)
    return lambda power, met: ((met @ screen.T) / white).prod(axis=1) * (screen @ power)


def by_factors(model: FactorModel) -> Product:
    return lambda power, met: model.rgb(model.reflectance(met).prod(axis=1) * model.light(power))


def unsharpened(model: FactorModel) -> Product:
    """The same component by component in the principal basis: what sharpening is for."""
    back = np.linalg.inv(model.transform).T

    def product(power: Array, met: Array) -> Array:
        coefficients = (model.reflectance(met) @ back).prod(axis=1) * (model.reflectance(power) @ back)
        return model.rgb(coefficients @ model.transform.T)

    return product


def by_matrices(model: FactorModel) -> Product:
    """The Λ model, the light being the first factor and within the span."""
    linear = LinearModel(model)
    return lambda power, met: model.rgb(
        linear.product(model.reflectance(power), *np.moveaxis(model.reflectance(met), 1, 0))
    )
