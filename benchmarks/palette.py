"""Accuracy of the palette's factor model, and pictures of the examples, for
docs/palette.md.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks import ATLASES, DOCS, Row, record
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
    """``powers`` (N,) by light, and the ``reflectances`` (n, k, N) along paths by
    number of reflections k.
    """

    sensor: Sensor
    powers: dict[str, Array]
    reflectances: dict[int, Array]

    def errors(self, product: Product, light: str, bounces: int) -> Array:
        """Return ΔE00 (n,) between a product's colours and those of complete spectra,
        both exposed to mid-grey.
        """
        power = self.powers[light]
        met = self.reflectances[bounces]
        full = (power * met.prod(axis=1)) @ screen_matrix(self.sensor).T
        gain = exposure(self.sensor, full)[:, None]
        return delta_e_rgb(self.sensor, gain * full, gain * product(power, met))


def light_paths(sensor: Sensor) -> LightPaths:
    atlases = read_atlas(*sorted((ATLASES).glob("*.txt")))
    materials = on_grid(atlases, sensor.wavelengths)
    draw = np.random.default_rng(2004)
    rows = {k: draw.integers(0, len(materials), (SAMPLES, k)) for k in BOUNCES[1:]}
    met = {1: materials[:, None]} | {k: materials[row] for k, row in rows.items()}
    return LightPaths(sensor, {name: illuminant(sensor, name) for name in LIGHTS}, met)


def by_rgb(sensor: Sensor) -> Product:
    """Return RGB products with the surfaces' RGB under a flat white (Bergner et al.
    2004, eq. 9–12).
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
        coefficients = (model.reflectance(met) @ back).prod(axis=1) * (
            model.reflectance(power) @ back
        )
        return model.rgb(coefficients @ model.transform.T)

    return product


def by_matrices(model: FactorModel) -> Product:
    """Return products of the Λ model; the light is the first factor, within
    the span.
    """
    return lambda power, met: model.rgb(
        linear_product(
            model, model.reflectance(power), *np.moveaxis(model.reflectance(met), 1, 0)
        )
    )


FOLDER = DOCS / "palette"
EXAMPLES = ("metamers", "vanish", "light", "constant")
COUNTS = (5, 6, 7, 8, 9)
DEFAULT = 7


def main() -> None:
    """Draw the examples, measure and store."""
    sensor = observer.sensor()
    models = {count: standard_model(sensor, count) for count in COUNTS}
    palettes = {
        name: design(read_palette(sample_path(f"{name}.toml")), models[DEFAULT])
        for name in EXAMPLES
    }
    for name, palette in palettes.items():
        plot_matrix(palette, matrix(palette), FOLDER / f"{name}-matrix.png", force=True)
    plot_spectra(palettes["metamers"], FOLDER / "metamers-spectra.png", force=True)
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
        errors = {
            k: np.concatenate([paths.errors(product, light, k) for light in LIGHTS])
            for k in BOUNCES
        }
        pairs = {
            str(k): [float(one.mean()), float(np.percentile(one, 95))]
            for k, one in errors.items()
        }
        rows.append(
            {
                "product": name,
                "errors": pairs,
                "all": float(np.mean([one[0] for one in pairs.values()])),
            }
        )
    return [row | {"gain": rows[0]["all"] / row["all"]} for row in rows]


def by_light(paths: LightPaths, light: str, model: FactorModel) -> Row:
    """Return mean ΔE00 under a light over all numbers of reflections."""
    products = {"rgb": by_rgb(paths.sensor), "factor": by_factors(model)}
    means = {
        name: float(np.mean([paths.errors(product, light, k).mean() for k in BOUNCES]))
        for name, product in products.items()
    }
    return {"light": light, **means, "gain": means["rgb"] / means["factor"]}
