"""``make palette``: how near the factor model comes, and the examples → docs/palette.md and its pictures."""

from __future__ import annotations

import warnings
from pathlib import Path

import uplift
from benchmarks import palette_tables as tables
from benchmarks.page import write
from benchmarks.palette_ways import ways
from uplift import observer
from uplift.palette import (
    FactorModel,
    design,
    matrix,
    plot_matrix,
    plot_spectra,
    read_palette,
    standard_model,
)

from .timing import ROOT

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
    introduction = (FOLDER / "introduction.md").read_text(encoding="utf-8")
    sections = [tables.by_bounces(measured, models), tables.by_light(measured, models[7])]
    print(write("palette", introduction, sections))


def _draw(name: str, model: FactorModel) -> None:
    found = design(read_palette(FOLDER / f"{name}.toml"), model)
    for draw, kind in ((_matrix, "matrix"), (plot_spectra, "spectra")):
        draw(found, FOLDER / f"{name}-{kind}.png", force=True)


def _matrix(found, path: Path, *, force: bool) -> None:
    plot_matrix(found, matrix(found), path, force=force)


if __name__ == "__main__":
    main()
