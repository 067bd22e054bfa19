"""Accuracy of the palette's factor model, and pictures of the examples, for
docs/palette.md.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks import ATLAS_FILES, DOCS, Row, record
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import Sensor, delta_e_rgb, observer
from uplift.common.arrays import Array
from uplift.extras.palette import (
    design,
    illuminant,
    matrix,
    read_palette,
    standard_model,
)
from uplift.extras.palette.colours import exposure, screen_matrix
from uplift.extras.palette.factor import FactorModel, linear_product
from uplift.extras.palette.plots import plot_matrix, plot_spectra
from uplift.samples import sample_path

LIGHTS = ("D65", "D50", "A", "E", "FL2", "FL7", "FL11", "LED-B3", "HP1")
BOUNCES = (1, 2, 3, 4)
SAMPLES = 2000
"""Random paths of two and more reflections; those of one are all materials."""

Product = Callable[[Array, Array], Array]
"""From a power (N,) and the reflectances (n, k, N) along paths to linear RGB (n, 3)."""


@dataclass(frozen=True, eq=False)
class LightPaths:
    """``powers`` (N,) by light, and ``reflectances`` (n, k, N) along paths of k
    reflections.
    """

    sensor: Sensor
    powers: dict[str, Array]
    reflectances: dict[int, Array]

    def errors(self, product: Product, light: str, bounces: int) -> Array:
        """Return ΔE00 (n,) from complete spectra, both exposed to mid-grey."""
        power = self.powers[light]
        met = self.reflectances[bounces]
        full = (power * met.prod(axis=1)) @ screen_matrix(self.sensor).T
        gain = exposure(self.sensor, full)[:, None]
        return delta_e_rgb(self.sensor, gain * full, gain * product(power, met))


def light_paths(sensor: Sensor) -> LightPaths:
    materials = on_grid(read_atlas(*ATLAS_FILES), sensor.wavelengths)
    rng = np.random.default_rng(2004)
    met = {1: materials[:, None]}
    for count in BOUNCES[1:]:
        met[count] = materials[rng.integers(0, len(materials), (SAMPLES, count))]
    return LightPaths(sensor, {name: illuminant(sensor, name) for name in LIGHTS}, met)


def by_rgb(sensor: Sensor) -> Product:
    """Return RGB products with the surfaces' RGB under a flat white.

    Bergner et al. 2004, eq. 9–12.
    """
    screen = screen_matrix(sensor)
    white = screen.sum(axis=1)
    return lambda power, met: ((met @ screen.T) / white).prod(axis=1) * (screen @ power)


def by_factors(model: FactorModel) -> Product:
    return lambda power, met: model.rgb(
        model.reflectance(met).prod(axis=1) * model.light(power)
    )


def unsharpened(model: FactorModel) -> Product:
    """Return products of components in the principal basis, without sharpening."""
    back = np.linalg.inv(model.transform).T

    def product(power: Array, met: Array) -> Array:
        surfaces = (model.reflectance(met) @ back).prod(axis=1)
        light = model.reflectance(power) @ back
        return model.rgb((surfaces * light) @ model.transform.T)

    return product


def by_matrices(model: FactorModel) -> Product:
    """Return products of the Λ model, whose first factor is the light in the span."""

    def product(power: Array, met: Array) -> Array:
        surfaces = np.moveaxis(model.reflectance(met), 1, 0)
        return model.rgb(linear_product(model, model.reflectance(power), *surfaces))

    return product


FOLDER = DOCS / "palette"
EXAMPLES = ("metamers", "vanish", "light", "constant")
COUNTS = (5, 6, 7, 8, 9)
DEFAULT = 7


def main() -> None:
    """Draw the examples, measure and store."""
    sensor = observer.sensor()
    models = {count: standard_model(sensor, count) for count in COUNTS}
    for name in EXAMPLES:
        palette = design(read_palette(sample_path(f"{name}.toml")), models[DEFAULT])
        plot_matrix(palette, matrix(palette), FOLDER / f"{name}-matrix.png", force=True)
        if name == "metamers":
            plot_spectra(palette, FOLDER / "metamers-spectra.png", force=True)
    paths = light_paths(sensor)
    products = {"RGB": by_rgb(sensor)}
    for count, model in models.items():
        products[f"factor model, m = {count}"] = by_factors(model)
        products[f"Λ model, m = {count}"] = by_matrices(model)
    products[f"m = {DEFAULT}, not sharpened"] = unsharpened(models[DEFAULT])
    record(
        "palette",
        spectra=len(paths.reflectances[1]),
        samples=SAMPLES,
        reflections=by_bounces(paths, products),
        lights=[by_light(paths, light, models[DEFAULT]) for light in LIGHTS],
    )


def by_bounces(paths: LightPaths, products: dict[str, Product]) -> list[Row]:
    """Return mean ΔE00 and 95th percentile by number of reflections, and the gain over
    RGB.
    """
    rows = []
    for name, product in products.items():
        pairs = {}
        for count in BOUNCES:
            errors = np.concatenate(
                [paths.errors(product, light, count) for light in LIGHTS]
            )
            pairs[count] = [errors.mean(), np.percentile(errors, 95)]
        mean, _ = np.mean(list(pairs.values()), axis=0)
        rows.append({"product": name, "errors": pairs, "all": mean})
    return [row | {"gain": rows[0]["all"] / row["all"]} for row in rows]


def by_light(paths: LightPaths, light: str, model: FactorModel) -> Row:
    """Return mean ΔE00 under a light over all numbers of reflections."""
    products = {"rgb": by_rgb(paths.sensor), "factor": by_factors(model)}
    means = {}
    for name, product in products.items():
        errors = [paths.errors(product, light, count).mean() for count in BOUNCES]
        means[name] = np.mean(errors)
    return {"light": light, **means, "gain": means["rgb"] / means["factor"]}
