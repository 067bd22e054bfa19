"""Accuracy of the palette's factor model, and pictures of the examples: ``make palette``.

Writes docs/data/palette.json and the pictures of docs/palette.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import uplift
from benchmarks.light_paths import (
    BOUNCES,
    LIGHTS,
    SAMPLES,
    LightPaths,
    Product,
    by_factors,
    by_matrices,
    by_rgb,
    light_paths,
    unsharpened,
)
from benchmarks.record import ROOT, write
from uplift.colorimetry import observer
from uplift.design.palette import (
    FactorModel,
    design,
    matrix,
    plot_matrix,
    plot_spectra,
    read_palette,
    standard_model,
)
from uplift.samples import sample_path

FOLDER = ROOT / "docs" / "palette"
EXAMPLES = ("metamers", "vanish", "light", "constant")
COUNTS = (5, 6, 7, 8, 9)
DEFAULT = 7


def main() -> None:
    """Draw the examples, measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    sensor = observer.sensor()
    models = {count: standard_model(sensor, count) for count in COUNTS}
    for name in EXAMPLES:
        draw(name, models[DEFAULT])
    paths = light_paths(sensor)
    products = {"RGB": by_rgb(sensor)}
    for count, model in models.items():
        products[f"factor model, m = {count}"] = by_factors(model)
        products[f"Λ model, m = {count}"] = by_matrices(model)
    products[f"m = {DEFAULT}, not sharpened"] = unsharpened(models[DEFAULT])
    write(
        "palette",
        "make palette",
        spectra=len(paths.reflectances[1]),
        samples=SAMPLES,
        reflections=by_bounces(paths, products),
        lights=[by_light(paths, light, models) for light in LIGHTS],
    )


def draw(name: str, model: FactorModel) -> None:
    """Design an example and plot its matrix and spectra."""
    palette = design(read_palette(sample_path(f"{name}.toml")), model)
    plot_matrix(palette, matrix(palette), FOLDER / f"{name}-matrix.png", force=True)
    plot_spectra(palette, FOLDER / f"{name}-spectra.png", force=True)


def by_bounces(paths: LightPaths, products: dict[str, Product]) -> list[dict[str, Any]]:
    """Return mean ΔE00 and 95th percentile by number of reflections, and the gain over RGB."""
    rows = []
    for name, product in products.items():
        errors = {k: np.concatenate([paths.errors(product, light, k) for light in LIGHTS]) for k in BOUNCES}
        pairs = {str(k): [float(one.mean()), float(np.percentile(one, 95))] for k, one in errors.items()}
        rows.append({"product": name, "errors": pairs, "all": float(np.mean([one[0] for one in pairs.values()]))})
    return [row | {"gain": rows[0]["all"] / row["all"]} for row in rows]


def by_light(paths: LightPaths, light: str, models: dict[int, FactorModel]) -> dict[str, Any]:
    """Return mean ΔE00 under a light over all numbers of reflections."""
    products = {
        "rgb": by_rgb(paths.sensor),
        "factor": by_factors(models[DEFAULT]),
        "lambda": by_matrices(models[DEFAULT]),
        "factor_8": by_factors(models[8]),
    }
    means = {
        name: float(np.mean([paths.errors(product, light, k).mean() for k in BOUNCES]))
        for name, product in products.items()
    }
    gains = {"gain": means["rgb"] / means["factor"], "gain_8": means["rgb"] / means["factor_8"]}
    return {"light": light, **means, **gains}


if __name__ == "__main__":
    main()
