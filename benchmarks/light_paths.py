"""Light paths of one to four reflections over the shipped atlases, and their colours by every kind of product."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.record import ROOT
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.palette import FactorModel, illuminant
from uplift.design.palette.colours import exposure, screen_matrix
from uplift.design.palette.factor import linear_product

LIGHTS = ("D65", "D50", "A", "E", "FL2", "FL7", "FL11", "LED-B3", "HP1")
BOUNCES = (1, 2, 3, 4)
SAMPLES = 2000
"""Random paths of two and more reflections; those of one are all materials."""

Product = Callable[[Array, Array], Array]
"""From a power (N,) and the reflectances (n, k, N) along paths to linear RGB (n, 3)."""


@dataclass(frozen=True, eq=False)
class LightPaths:
    """``powers`` (N,) by light, and the ``reflectances`` (n, k, N) along paths by number of reflections k."""

    sensor: Sensor
    powers: dict[str, Array]
    reflectances: dict[int, Array]

    def errors(self, product: Product, light: str, bounces: int) -> Array:
        """Return ΔE00 (n,) between a product's colours and those of complete spectra, both exposed to mid-grey."""
        power, met = self.powers[light], self.reflectances[bounces]
        full = (power * met.prod(axis=1)) @ screen_matrix(self.sensor).T
        gain = exposure(self.sensor, full)[:, None]
        return delta_e_rgb(self.sensor, gain * full, gain * product(power, met))


def light_paths(sensor: Sensor) -> LightPaths:
    atlases = read_atlas(*sorted((ROOT / "atlases").glob("*.txt")))
    materials = on_grid(atlases, sensor.wavelengths)
    draw = np.random.default_rng(2004)
    rows = {k: draw.integers(0, len(materials), (SAMPLES, k)) for k in BOUNCES[1:]}
    met = {1: materials[:, None]} | {k: materials[row] for k, row in rows.items()}
    return LightPaths(sensor, {name: illuminant(sensor, name) for name in LIGHTS}, met)


def by_rgb(sensor: Sensor) -> Product:
    """Return RGB products with the surfaces' RGB under a flat white (Bergner et al. 2004, eq. 9–12)."""
    screen = screen_matrix(sensor)
    white = screen.sum(axis=1)
    return lambda power, met: ((met @ screen.T) / white).prod(axis=1) * (screen @ power)


def by_factors(model: FactorModel) -> Product:
    return lambda power, met: model.rgb(model.reflectance(met).prod(axis=1) * model.light(power))


def unsharpened(model: FactorModel) -> Product:
    """Return products of components in the principal basis, without sharpening."""
    back = np.linalg.inv(model.transform).T

    def product(power: Array, met: Array) -> Array:
        coefficients = (model.reflectance(met) @ back).prod(axis=1) * (model.reflectance(power) @ back)
        return model.rgb(coefficients @ model.transform.T)

    return product


def by_matrices(model: FactorModel) -> Product:
    """Return products of the Λ model; the light is the first factor, within the span."""
    return lambda power, met: model.rgb(
        linear_product(model, model.reflectance(power), *np.moveaxis(model.reflectance(met), 1, 0))
    )
