"""Accuracy of the palette's factor model, and pictures of the examples, for
docs/palette.md.
"""

from collections.abc import Callable
from functools import partial
from itertools import product

import numpy as np

from benchmarks import ATLAS_FILES, DOCS, Row, summary
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.papers.palette.colours import exposure, illuminant, screen_matrix
from uplift.extras.papers.palette.design import design, matrix
from uplift.extras.papers.palette.factor import (
    FactorModel,
    linear_product,
    standard_model,
)
from uplift.extras.papers.palette.plots import plot_matrix, plot_spectra
from uplift.extras.papers.palette.spec import read_palette
from uplift.samples import sample_path

LIGHTS = ("D65", "D50", "A", "E", "FL2", "FL7", "FL11", "LED-B3", "HP1")
REFLECTIONS = (1, 2, 3, 4)
SAMPLES = 2000
"""Random paths of two and more reflections; those of one are all materials."""
FOLDER = DOCS / "palette"
EXAMPLES = ("metamers", "vanish", "light", "constant")
COUNTS = (5, 6, 7, 8, 9)
DEFAULT = 7
Product = Callable[[Array, Array], Array]
"""From a power (N,) and the reflectances (n, k, N) along paths to linear RGB (n, 3)."""


def by_rgb(sensor: Sensor, power: Array, met: Array) -> Array:
    """Return RGB products with the surfaces' RGB under a flat white.

    Bergner et al. 2004, eq. 9–12.
    """
    screen = screen_matrix(sensor)
    surfaces = (met @ screen.T) / screen.sum(axis=1)
    return surfaces.prod(axis=1) * (screen @ power)


def by_factors(model: FactorModel, power: Array, met: Array) -> Array:
    """Return products of coefficients."""
    return model.rgb(model.reflectance(met).prod(axis=1) * model.light(power))


def by_matrices(model: FactorModel, power: Array, met: Array) -> Array:
    """Return products of the Λ model, whose first factor is the light in the span."""
    surfaces = np.moveaxis(model.reflectance(met), 1, 0)
    return model.rgb(linear_product(model, model.reflectance(power), *surfaces))


def pictures() -> None:
    """Draw the examples."""
    model = standard_model(observer.sensor(), DEFAULT)
    for name in EXAMPLES:
        palette = design(read_palette(sample_path(f"{name}.toml")), model)
        plot_matrix(palette, matrix(palette), FOLDER / f"{name}-matrix.png", force=True)
        if name == "metamers":
            plot_spectra(palette, FOLDER / "metamers-spectra.png", force=True)


def errors() -> list[Row]:
    """Return ΔE00 from complete spectra, both exposed to mid-grey, by product, light
    and number of reflections.
    """
    sensor = observer.sensor()
    products: dict[str, Product] = {"RGB": partial(by_rgb, sensor)}
    for count in COUNTS:
        model = standard_model(sensor, count)
        products[f"factor model, m = {count}"] = partial(by_factors, model)
        products[f"Λ model, m = {count}"] = partial(by_matrices, model)
    materials = on_grid(read_atlas(*ATLAS_FILES), sensor.wavelengths)
    rng = np.random.default_rng(2004)
    paths = {1: materials[:, None]}
    for count in REFLECTIONS[1:]:
        paths[count] = materials[rng.integers(0, len(materials), (SAMPLES, count))]
    rows = []
    for light, reflections in product(LIGHTS, REFLECTIONS):
        power = illuminant(sensor, light)
        met = paths[reflections]
        full = (power * met.prod(axis=1)) @ screen_matrix(sensor).T
        gain = exposure(sensor, full)[:, None]
        for name, multiply in products.items():
            found = delta_e_rgb(sensor, gain * full, gain * multiply(power, met))
            head = {"product": name, "light": light, "reflections": reflections}
            rows.append(head | summary(found))
    return rows


QUESTIONS = {"pictures": pictures, "errors": errors}
