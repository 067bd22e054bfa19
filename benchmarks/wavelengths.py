"""Selection of wavelengths, and reproduction of Meyer 1988, for docs/scene.md and its
pictures.
"""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, DOCS, MACBETH, Row, record
from benchmarks.meyer import (
    COLOURS,
    compare_meyer,
    figure_6,
    figure_7,
    run_trials,
    style_counts,
)
from uplift.atlas import on_grid
from uplift.common.arrays import Array
from uplift.extras.pages.figure import INK, new_figure, styled, write_png
from uplift.extras.scene.wavelengths import METHODS, choose, grid, make_setup
from uplift.extras.scene.wavelengths import meyer as paper
from uplift.extras.scene.wavelengths.sampling import evaluate, statistics

SPACES = {"AC1C2": "opponent", "SML": "cones", "XYZ": "xyz"}
"""Names of the paper, and of `uplift.extras.scene.wavelengths.choose_orders`."""
OPTIMISED = "optimised"
OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
LIGHTS = (("A", "B", "C", "D65"), ("FL2", "FL7", "FL11"))
"""Smooth ones, and spiky ones."""
PICTURES = DOCS / "wavelengths"

Errors = Mapping[tuple[str, int], Array]
"""By method and number of wavelengths."""


def compare_methods(materials: Array, lights: tuple[str, ...]) -> dict[str, Errors]:
    """Evaluate all methods with all numbers of wavelengths under several lights at
    once.

    ``unseen``: fitted to the even ones, tested on the odd ones; methods that are not
    fitted get the latter, which favours Meyer's allocation. ``all``: fitted to and
    tested on all.
    """
    setup = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    fitted = setup.only(~odd)
    tested = setup.only(odd)
    unseen = {}
    every = {}
    for count, method in product(COUNTS, METHODS):
        sampling = METHODS[method](tested if method in OTHERS else fitted, count)
        unseen[method, count] = evaluate(tested, sampling)
        every[method, count] = choose(setup, method=method, count=count).errors
    return {"unseen": unseen, "all": every}


def tables(
    lights: tuple[str, ...], comparison: Mapping[str, Errors]
) -> Iterator[tuple[Row, list[Row]]]:
    """Yield the summary of a test and its rows: [mean, 95th percentile, largest] ΔE00
    of every method.

    ``gain`` is the ratio of the best other method's mean to the optimised one's.
    ``needed`` are the fewest wavelengths for a mean of 1; None if 16 do not reach it.
    """
    for materials, errors in comparison.items():
        means = mean_errors(errors)
        gains = np.min([means[other] for other in OTHERS], axis=0) / means[OPTIMISED]
        head = {"lights": ", ".join(lights), "materials": materials}
        rows = []
        for count, gain in zip(COUNTS, gains, strict=True):
            values = {
                method: [*statistics(errors[method, count]).values()]
                for method in METHODS
            }
            rows.append({**head, "count": count, "errors": values, "gain": gain})
        needed = {}
        for method, values in means.items():
            reached = np.flatnonzero(values <= 1)
            needed[method] = COUNTS[reached[0]] if len(reached) else None
        summary = {
            **head,
            "other_gain": spread(gains),
            "fitted_gain": spread(means["fitted"] / means[OPTIMISED]),
            "needed": needed,
        }
        yield summary, rows


def mean_errors(errors: Errors) -> dict[str, Array]:
    """Return the mean errors over `COUNTS` by method."""
    means = {}
    for method in METHODS:
        means[method] = np.array([errors[method, count].mean() for count in COUNTS])
    return means


def spread(ratios: Array) -> Row:
    """Return the median, smallest and largest of ratios over `COUNTS`."""
    return {
        "median": np.median(ratios),
        "min": ratios.min(),
        "max": ratios.max(),
    }


# --- pictures ---


def plot_methods(comparisons: Mapping[tuple[str, ...], Mapping[str, Errors]]) -> Any:
    """Plot mean ΔE00 on held-out materials over the number of wavelengths."""
    figure = new_figure(7.2, 3.4)
    panels = figure.subplots(1, len(comparisons), sharey=True)
    for axes, (lights, comparison) in zip(panels, comparisons.items(), strict=True):
        means = mean_errors(comparison["unseen"])
        for (method, values), colour in zip(means.items(), COLOURS, strict=True):
            axes.plot(COUNTS, values, "o-", color=colour, markersize=3, label=method)
        axes.set_title(", ".join(lights), loc="left", fontsize=9, color=INK)
        style_counts(axes)
    panels[0].set_ylabel("mean ΔE00, unseen materials")
    figure.legend(
        *panels[0].get_legend_handles_labels(),
        loc="outside upper center",
        ncols=5,
        frameon=False,
    )
    return figure


def main() -> None:
    """Measure, draw and store."""
    checker = make_setup(on_grid(uplift.read_atlas(MACBETH), grid()), ["C"])
    spaces = {
        name: paper.SPACES[key](checker.wavelengths, checker.cmfs)
        for name, key in SPACES.items()
    }
    trials = {name: run_trials(checker, space) for name, space in spaces.items()}
    materials = on_grid(uplift.read_atlas(*ATLAS_FILES), grid())
    comparisons = {lights: compare_methods(materials, lights) for lights in LIGHTS}
    summaries = []
    errors = []
    for lights, comparison in comparisons.items():
        for summary, rows in tables(lights, comparison):
            summaries.append(summary)
            errors += rows
    PICTURES.mkdir(exist_ok=True)
    with styled():
        write_png(figure_6(trials), PICTURES / "figure-6.png", force=True)
        write_png(figure_7(*trials["AC1C2"]), PICTURES / "figure-7.png", force=True)
        write_png(plot_methods(comparisons), PICTURES / "methods.png", force=True)
    record(
        "wavelengths",
        materials=len(materials),
        summary=summaries,
        errors=errors,
        **compare_meyer(checker, spaces),
    )
