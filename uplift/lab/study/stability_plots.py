"""The failure map: what varies over every grid of the design, as heat maps with their numbers."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.study.stability import RunConfig, RunResult
from uplift.lab.study.stability_design import Grid
from uplift.viz.figure import new_figure, write_png

LOUD, FAINT, INK = "#ff5a00", "#ffcfae", "#1b2733"
RAMP = ("#eef5f8", "#a9cfe3", "#5a9fcb", "#20609a", "#0b1d51")
"""Pale for little, dark for much: one hue, so that orange means failure and nothing else."""
CELL, HEIGHT = 0.56, 0.34


@dataclass(frozen=True)
class Quantity:
    """What a column of panels shows of an outcome: a value from 0 to 1 for the colour, and a text for the cell."""

    title: str
    value: Callable[[RunResult], float]
    text: Callable[[RunResult], str]


def _decades(value: float, low: float, high: float) -> float:
    """Where a value lies between two others, 0 to 1, logarithmic."""
    return float(np.clip(np.log10(max(value, low) / low) / np.log10(high / low), 0, 1))


def _failed(outcome: RunResult) -> str:
    stand_ins = f" ({outcome.stand_ins})" if outcome.stand_ins else ""
    return (f"{outcome.unfitted}" if outcome.unfitted or stand_ins else "·") + stand_ins


def _calls(outcome: RunResult) -> str:
    return f"{outcome.rounds}/{outcome.calls}" if outcome.rounds or outcome.calls else "·"


QUANTITIES = (
    Quantity("unfitted points (stand-ins)", lambda one: 0.0, _failed),
    Quantity(
        "worst distance / threshold",
        lambda one: _decades(one.worst / one.setting.threshold, 1e-2, 1),
        lambda one: f"{one.worst / one.setting.threshold:.2g}",
    ),
    Quantity("rounds / improvement calls", lambda one: _decades(1 + one.rounds + one.calls, 1, 1e3), _calls),
    Quantity("seconds", lambda one: _decades(one.seconds, 0.1, 100), lambda one: f"{one.seconds:.2g}"),
)
"""The scale of a column is the same in all grids."""


def plot_map(
    grids: Sequence[Grid],
    outcomes: Mapping[RunConfig, RunResult],
    path: str | os.PathLike[str],
    *,
    force: bool = False,
) -> None:
    """Draw a row of panels a grid and a column a quantity; orange where points fail, faint where stand-ins do.

    Raises `OutputError`.
    """
    tall = [len(grid.techniques) * HEIGHT + 0.75 for grid in grids]
    wide = max(len(grid.values) for grid in grids) * CELL + 0.3
    figure = new_figure(1.2 + len(QUANTITIES) * wide, sum(tall))
    panels = figure.subplots(len(grids), len(QUANTITIES), squeeze=False, height_ratios=tall)
    for number, (row, grid) in enumerate(zip(panels, grids, strict=True)):
        found = [[outcomes[setting] for setting in settings] for _, settings in grid.rows()]
        for axes, quantity in zip(row, QUANTITIES, strict=True):
            _panel(axes, grid, found, quantity)
            if number == 0:
                axes.text(0, 1.32, quantity.title, transform=axes.transAxes, weight="bold", color=INK)
        row[0].set_title(grid.title, loc="left", fontsize=9, color=INK)
        row[0].set_yticks(range(len(grid.techniques)), [name for name, _ in grid.rows()])
    write_png(figure, path, force=force)


def _panel(axes: Any, grid: Grid, found: list[list[RunResult]], quantity: Quantity) -> None:
    values = np.array([[quantity.value(one) for one in row] for row in found])
    failed = np.array([[one.unfitted > 0 for one in row] for row in found])
    missed = np.array([[one.stand_ins > 0 and quantity is QUANTITIES[0] for one in row] for row in found])
    axes.imshow(_colours(values, failed, missed), aspect="auto", interpolation="nearest")
    for (row, column), share in np.ndenumerate(values):
        colour = "white" if share > 0.55 and not failed[row, column] else INK
        axes.text(
            column,
            row,
            quantity.text(found[row][column]),
            ha="center",
            va="center",
            fontsize=7.5,
            color=colour,
        )
    axes.set_xticks(range(len(grid.values)), [_short(value) for value in grid.values], fontsize=8)
    axes.set_yticks([])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.set_xticks(np.arange(len(grid.values) - 1) + 0.5, minor=True)
    axes.set_yticks(np.arange(len(found) - 1) + 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.5)
    axes.tick_params(which="minor", length=0)


def _colours(values: Array, failed: Any, missed: Any) -> Any:
    from matplotlib.colors import LinearSegmentedColormap, to_rgb

    ramp = LinearSegmentedColormap.from_list("ramp", RAMP)(values)[..., :3]
    ramp = np.where(missed[..., None], to_rgb(FAINT), ramp)
    return np.where(failed[..., None], to_rgb(LOUD), ramp)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.0e}".replace("e-0", "e-")
    return str(value).removeprefix("ITU-R ").removesuffix(" RGB")
