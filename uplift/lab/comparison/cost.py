"""The chart of error over cost: for each set of lights over the time of a product, and over the floats stored."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.legend import FRONT, PLAIN
from uplift.lab.chart.legend import STYLE as KEY
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.lab.comparison.style import colour, families, heading
from uplift.viz.figure import new_figure
from uplift.viz.format import format_time
from uplift.viz.scatter import Name, label, pareto_steps, set_up

PANEL, KEY_HEIGHT = (6.0, 4.0), 0.55
"""Inches of a panel, and of the key below all."""
JOINED = {"linewidth": 0.8, "alpha": 0.45, "zorder": 1}
"""Lines from each size of a family to the next."""
LEAST = 1e-3
"""ΔE00 below are drawn there: nobody sees less."""


@dataclass(frozen=True)
class Cost:
    """What is drawn across: its title, a row's, how it is told, and where; without ``ticks`` at powers of ten."""

    title: str
    of: Callable[[RepresentationResult], float]
    told: Callable[[float], str]
    ticks: tuple[float, ...] = ()


COSTS = (
    Cost("CPU time of a product", lambda row: row.ns.median, format_time),
    Cost("floats stored of a surface", lambda row: row.floats, "{:g}".format, (4, 8, 16, 32, 64, 128, 256)),
)


def draw(found: Comparison) -> Any:
    """A matplotlib figure. What stands for a representation is named ``marker-<panel>-<number>``, and ``label-…``,
    numbered as `numbered` does."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    height = PANEL[1] * len(found.sets) + KEY_HEIGHT
    figure = new_figure(PANEL[0] * len(COSTS), height, layout=None)
    inch = 1 / height
    figure.subplots_adjust(
        left=0.06,
        right=0.985,
        bottom=(KEY_HEIGHT + 0.6) * inch,
        top=1 - 0.35 * inch,
        wspace=0.13,
        hspace=0.27,
    )
    FigureCanvasAgg(figure)
    cells = figure.subplots(len(found.sets), len(COSTS), squeeze=False)
    numbers = numbered(found)
    drawn = [
        (axes, cost, found.of(name), panel, title)
        for panel, (axes, (name, title), cost) in enumerate(
            (axes, part, cost)
            for row, part in zip(cells, found.sets.items(), strict=True)
            for axes, cost in zip(row, COSTS, strict=True)
        )
    ]
    for axes, cost, rows, panel, title in drawn:
        _draw_panel(axes, title, cost, rows, {name: f"{panel}-{number}" for name, number in numbers.items()})
    _key(figure, found)
    for axes, cost, rows, panel, _ in drawn:
        _label(axes, cost, rows, {name: f"{panel}-{number}" for name, number in numbers.items()})
    return figure


def numbered(found: Comparison) -> dict[str, int]:
    """The number of each representation, whatever the set."""
    return {name: number for number, name in enumerate(dict.fromkeys(row.name for row in found.rows))}


def _point(row: RepresentationResult, cost: Cost) -> tuple[float, float]:
    return max(cost.of(row), 1.0), max(row.statistics.q97_5, LEAST)


def front(rows: Sequence[RepresentationResult], cost: Cost) -> list[RepresentationResult]:
    """The Pareto front, the cheapest first: who costs more than another on it is nearer."""
    found: list[RepresentationResult] = []
    for row in sorted(rows, key=lambda row: _point(row, cost)):
        if not found or _point(row, cost)[1] < _point(found[-1], cost)[1]:
            found.append(row)
    return found


def _draw_panel(
    axes: Any, title: str, cost: Cost, rows: Sequence[RepresentationResult], gids: dict[str, str]
) -> None:
    set_up(axes, f"{heading(title)}, ΔE00 of 97.5 %", cost.title)
    if cost.ticks:
        axes.set_xticks(cost.ticks)
    axes.xaxis.set_major_formatter(lambda value, _: cost.told(value))
    axes.yaxis.set_major_formatter("{x:g}")
    ahead = front(rows, cost)
    for family in families(rows):
        members = sorted((row for row in rows if row.family == family), key=lambda row: row.floats)
        for pair in pairwise(members):
            ends = np.array([_point(row, cost) for row in pair])
            axes.plot(*ends.T, gid=f"whisker-{gids[pair[1].name]}", **{**JOINED, "color": colour(family)})
    for row in rows:
        axes.plot(
            *_point(row, cost),
            **{**PLAIN, "color": colour(row.family), "markersize": 7.5 if row in ahead else 6.0},
            gid=f"marker-{gids[row.name]}",
            zorder=3 if row in ahead else 2,
        )
    axes.margins(0.07)
    axes.plot(*_stairs(axes, cost, rows).T, scalex=False, zorder=1, **FRONT)


def _stairs(axes: Any, cost: Cost, rows: Sequence[RepresentationResult]) -> Array:
    points = np.array([_point(row, cost) for row in front(rows, cost)])
    return pareto_steps(points, axes.get_xlim()[1])


def _label(axes: Any, cost: Cost, rows: Sequence[RepresentationResult], gids: dict[str, str]) -> None:
    ahead = front(rows, cost)
    names = [
        Name(row.name, _point(row, cost), colour(row.family), row in ahead, f"label-{gids[row.name]}")
        for row in rows
    ]
    label(axes, names, np.array([name.point for name in names]), _stairs(axes, cost, rows))


def _key(figure: Any, found: Comparison) -> None:
    from matplotlib.lines import Line2D

    entries = [(name, {**PLAIN, "color": code}) for name, code in families(found.rows).items()]
    entries.append(("Pareto front", {**PLAIN, **FRONT}))
    handles = [Line2D([], [], **style) for _, style in entries]
    figure.legend(handles, [name for name, _ in entries], loc="lower center", ncols=6, **KEY)
