"""Selection of wavelengths for docs/scene.md and its picture."""

from itertools import product

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, DOCS, Row, summary
from uplift.atlas.resampling import on_grid
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.papers.wavelengths.choice import METHODS
from uplift.extras.papers.wavelengths.sampling import evaluate, grid, make_setup

OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
LIGHTS = (("A", "B", "C", "D65"), ("FL2", "FL7", "FL11"))
"""Smooth ones, and spiky ones."""
COLOURS = ("#20509a", "#d1495b", "#2e8b57", "#c98a1b", "#7fa3d9")


def errors() -> list[Row]:
    """Return ΔE00 of all methods and numbers of wavelengths under several lights at
    once, fitted to the even materials and tested on the odd ones.

    Methods that are not fitted get the latter, which favours Meyer's allocation.
    """
    materials = on_grid(uplift.read_atlas(*ATLAS_FILES), grid())
    is_odd = np.arange(len(materials)) % 2 == 1
    rows = []
    for lights in LIGHTS:
        setup = make_setup(materials, lights)
        fitted = setup.only(~is_odd)
        tested = setup.only(is_odd)
        for count, method in product(COUNTS, METHODS):
            known = tested if method in OTHERS else fitted
            found = evaluate(tested, METHODS[method](known, count))
            head = {"lights": ", ".join(lights), "method": method, "count": count}
            rows.append({**head, **summary(found.ravel())})
    plot(rows)
    return rows


def plot(rows: list[Row]) -> None:
    """Plot mean ΔE00 over the number of wavelengths."""
    panels = []
    for lights in LIGHTS:
        marks = []
        for method, colour in zip(METHODS, COLOURS, strict=True):
            same = {"lights": ", ".join(lights), "method": method}
            means = [row["mean"] for row in rows if row.items() >= same.items()]
            marks.append(line(COUNTS, means, method, colour, marker="o", markersize=3))
        y = Axis("mean ΔE00, unseen materials", log=True)
        panels.append(Panel(marks, ", ".join(lights), Axis("wavelengths"), y))
    figure = draw(panels, 2, legend="above", share="y")
    write_figure(figure, DOCS / "wavelengths" / "methods.png", force=True)


QUESTIONS = {"errors": errors}
