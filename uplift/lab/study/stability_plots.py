"""Failure map: heat maps with numbers, one row of panels per grid of the design and one column per quantity."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Mask, StrPath
from uplift.lab.study.stability import Grid, RunConfig, RunResult
from uplift.viz.figure import colour_map, figure_text, new_figure, write_png

HIGHLIGHT, FAINT, INK = "#ff5a00", "#ffcfae", "#1b2733"
CELL_WIDTH, CELL_HEIGHT = 0.56, 0.34
"""Inches."""


@dataclass(frozen=True)
class Quantity:
    """A column of panels: a value in [0, 1] for the colour of a cell, and its text."""

    title: str
    value: Callable[[RunResult], float]
    text: Callable[[RunResult], str]


def _log_fraction(value: float, low: float, high: float) -> float:
    """Position of a value between two others on a logarithmic scale, clipped to [0, 1]."""
    return float(np.clip(np.log10(max(value, low) / low) / np.log10(high / low), 0, 1))


def _failure_text(result: RunResult) -> str:
    stand_ins = f" ({result.stand_ins})" if result.stand_ins else ""
    return (f"{result.unfitted}" if result.unfitted or stand_ins else "·") + stand_ins


def _calls_text(result: RunResult) -> str:
    return f"{result.rounds}/{result.calls}" if result.rounds or result.calls else "·"


FAILURES = Quantity("unfitted points (stand-ins)", lambda result: 0.0, _failure_text)
QUANTITIES = (
    FAILURES,
    Quantity(
        "worst distance / threshold",
        lambda result: _log_fraction(result.worst / result.config.threshold, 1e-2, 1),
        lambda result: f"{result.worst / result.config.threshold:.2g}",
    ),
    Quantity(
        "rounds / improvement calls",
        lambda result: _log_fraction(1 + result.rounds + result.calls, 1, 1e3),
        _calls_text,
    ),
    Quantity(
        "seconds",
        lambda result: _log_fraction(result.seconds, 0.1, 100),
        lambda result: f"{result.seconds:.2g}",
    ),
)
"""Columns; each has one scale for all grids."""


def plot_map(
    grids: Sequence[Grid], results: Mapping[RunConfig, RunResult], path: StrPath, *, force: bool = False
) -> None:
    """Write the failure map as PNG; orange marks failed points, pale orange failed stand-ins. Raises `OutputError`."""
    heights = [len(grid.variants) * CELL_HEIGHT + 0.75 for grid in grids]
    width = max(len(grid.values) for grid in grids) * CELL_WIDTH + 0.3
    figure = new_figure(1.2 + len(QUANTITIES) * width, sum(heights))
    panels = figure.subplots(len(grids), len(QUANTITIES), squeeze=False, height_ratios=heights)
    for row, grid in zip(panels, grids, strict=True):
        table = [[results[config] for config in configs] for _, configs in grid.rows()]
        for axes, quantity in zip(row, QUANTITIES, strict=True):
            _draw_panel(axes, grid, table, quantity)
        row[0].set_title(grid.title, loc="left", fontsize=9, color=INK)
        row[0].set_yticks(range(len(grid.variants)), [figure_text(label) for label, _ in grid.rows()])
    for axes, quantity in zip(panels[0], QUANTITIES, strict=True):
        axes.text(0, 1.32, quantity.title, transform=axes.transAxes, weight="bold", color=INK)
    write_png(figure, path, force=force)


def _draw_panel(axes: Any, grid: Grid, table: list[list[RunResult]], quantity: Quantity) -> None:
    values = np.array([[quantity.value(result) for result in row] for row in table])
    failed = np.array([[result.unfitted > 0 for result in row] for row in table])
    stand_ins = np.array([[result.stand_ins > 0 and quantity is FAILURES for result in row] for row in table])
    axes.imshow(_colours(values, failed, stand_ins), aspect="auto", interpolation="nearest")
    for (row, column), value in np.ndenumerate(values):
        colour = "white" if value > 0.55 and not failed[row, column] else INK
        text = quantity.text(table[row][column])
        axes.text(column, row, text, ha="center", va="center", fontsize=7.5, color=colour)
    axes.set_xticks(range(len(grid.values)), [_short(value) for value in grid.values], fontsize=8)
    axes.set_yticks([])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.set_xticks(np.arange(len(grid.values) - 1) + 0.5, minor=True)
    axes.set_yticks(np.arange(len(table) - 1) + 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.5)
    axes.tick_params(which="minor", length=0)


def _colours(values: Array, failed: Mask, stand_ins: Mask) -> Array:
    from matplotlib.colors import to_rgb

    ramp = colour_map()(values)[..., :3]
    ramp = np.where(stand_ins[..., None], to_rgb(FAINT), ramp)
    return np.where(failed[..., None], to_rgb(HIGHLIGHT), ramp)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.0e}".replace("e-0", "e-")
    return figure_text(str(value).removeprefix("ITU-R ").removesuffix(" RGB"))
