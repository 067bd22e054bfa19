"""Tables of docs/palette.md."""

from __future__ import annotations

import numpy as np

from benchmarks.page import table
from benchmarks.palette_ways import (
    BOUNCES,
    LIGHTS,
    Product,
    Ways,
    by_factors,
    by_matrices,
    by_rgb,
    unsharpened,
)
from uplift.design.palette import FactorModel


def by_bounces(ways: Ways, models: dict[int, FactorModel]) -> str:
    products = {"RGB": by_rgb(ways.sensor)}
    for count, model in models.items():
        products[f"factor model, m = {count}"] = by_factors(model)
        products[f"Λ model, m = {count}"] = by_matrices(model)
    products["m = 7, not sharpened"] = unsharpened(models[7])
    means = {name: _means(ways, product) for name, product in products.items()}
    return table(
        "Reflections",
        f"Mean ΔE00, and 95th percentile, over {len(LIGHTS)} lights; how many times better than RGB over all.",
        ["product", *(f"{k} reflection{'s' * (k > 1)}" for k in BOUNCES), "all", "RGB ÷ it"],
        (_row(name, means[name], means["RGB"]) for name in products),
    )


def by_light(ways: Ways, models: dict[int, FactorModel]) -> str:
    seven, eight = models[7], models[8]
    products = (by_rgb(ways.sensor), by_factors(seven), by_matrices(seven), by_factors(eight))
    return table(
        "Lights",
        "Mean ΔE00 over one to four reflections; m = 7 but for the last two columns.",
        ["light", "RGB", "factor model", "RGB ÷ it", "Λ model", "factor model, m = 8", "RGB ÷ it"],
        (_light(ways, light, products) for light in LIGHTS),
    )


def _means(ways: Ways, product: Product) -> dict[int, tuple[float, float]]:
    """Mean and 95th percentile for every number of reflections."""
    found = {k: np.concatenate([ways.errors(product, light, k) for light in LIGHTS]) for k in BOUNCES}
    return {k: (float(errors.mean()), float(np.percentile(errors, 95))) for k, errors in found.items()}


def _row(name: str, means: dict[int, tuple[float, float]], rgb: dict[int, tuple[float, float]]) -> list[str]:
    total, reference = (np.mean([mean for mean, _ in found.values()]) for found in (means, rgb))
    cells = [f"{mean:.2f}, {high:.2f}" for mean, high in means.values()]
    return [name, *cells, f"{total:.2f}", f"{reference / total:.1f}"]


def _light(ways: Ways, light: str, products: tuple[Product, ...]) -> list[str]:
    rgb, seven, matrices, eight = (
        float(np.mean([ways.errors(product, light, k).mean() for k in BOUNCES])) for product in products
    )
    cells = (rgb, seven, rgb / seven, matrices, eight, rgb / eight)
    return [light, *(f"{cell:.{1 if row in (2, 5) else 2}f}" for row, cell in enumerate(cells))]
