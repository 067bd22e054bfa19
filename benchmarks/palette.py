"""``make palette``: how near the factor model comes, and the examples → docs/palette.md and its pictures."""

from __future__ import annotations

import warnings

import numpy as np

import uplift
from benchmarks import palette_tables as tables
from benchmarks.page import write
from benchmarks.palette_introduction import INTRODUCTION
from benchmarks.palette_ways import BOUNCES, DRAWN, LIGHTS, Product, Ways, by_factors, by_rgb, ways
from benchmarks.timing import ROOT
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

FOLDER = ROOT / "docs" / "palette"
EXAMPLES = ("metamers", "vanish", "light", "constant")
COUNTS = (5, 6, 7, 8, 9)


def main() -> None:
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    sensor = observer.sensor()
    models = {count: standard_model(sensor, count) for count in COUNTS}
    for name in EXAMPLES:
        _draw(name, models[7])
    measured = ways(sensor)
    specs = {name: (FOLDER / f"{name}.toml").read_text(encoding="utf-8") for name in EXAMPLES}
    introduction = INTRODUCTION.format(**specs, **_figures(measured, models))
    sections = [tables.by_bounces(measured, models), tables.by_light(measured, models)]
    print(write("palette", introduction, sections))


def _draw(name: str, model: FactorModel) -> None:
    found = design(read_palette(FOLDER / f"{name}.toml"), model)
    plot_matrix(found, matrix(found), FOLDER / f"{name}-matrix.png", force=True)
    plot_spectra(found, FOLDER / f"{name}-spectra.png", force=True)


def _figures(measured: Ways, models: dict[int, FactorModel]) -> dict[str, str]:
    """The numbers that the words name."""
    rgb, seven, eight = (
        _by_light(measured, product)
        for product in (by_rgb(measured.sensor), by_factors(models[7]), by_factors(models[8]))
    )
    ratios = {light: rgb[light] / seven[light] for light in LIGHTS}
    short = [light for light in LIGHTS if ratios[light] < 5]
    worst = min(ratios, key=ratios.__getitem__)

    def mean(errors: dict[str, float]) -> float:
        return float(np.mean(list(errors.values())))

    return {
        "better": f"{mean(rgb) / mean(seven):.1f}",
        "factor": f"{mean(seven):.2f}",
        "rgb": f"{mean(rgb):.2f}",
        "entries": str(len(measured.met[1])),
        "worst": " and ".join(short) or "none",
        "worst_factor": f"{ratios[worst]:.1f}",
        "worst_eight": f"{rgb[worst] / eight[worst]:.1f}",
        "eight": f"{mean(rgb) / mean(eight):.1f}",
        "drawn": f"{DRAWN:,}",
    }


def _by_light(measured: Ways, product: Product) -> dict[str, float]:
    """Mean ΔE00 under each light, over all numbers of reflections."""
    return {
        light: float(np.mean([measured.errors(product, light, k).mean() for k in BOUNCES]))
        for light in LIGHTS
    }


if __name__ == "__main__":
    main()
