"""A panel of error over time: markers, whiskers, the Pareto front and labels.

Of the cubes of this package a panel shows those that no other cube of the same kind and mode beats.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.legend import SINGLE, WHISKER, family_colours, marker_style
from uplift.lab.chart.panels import CLEAR_RATIO, MIN_ERROR, Panel
from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.format import format_time
from uplift.viz.scatter import (
    FRONT_LINE,
    Label,
    draw_labels,
    pareto_front,
    pareto_steps,
    set_log_ticks,
    style_log_axes,
)


def draw_panel(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    """Draw markers, whiskers and the Pareto front; ``number`` is part of the names of the artists."""
    _style_axes(axes, panel)
    front, colours = panel.front(chart), _colours(chart)
    for row, result in drawn_results(panel, chart):
        _draw_result(axes, panel, result, f"{number}-{row}", colours[result.family], on_front=result in front)
    axes.margins(0.06)
    set_log_ticks(axes.yaxis)
    if front:
        axes.plot(*_front_line(axes, panel, chart).T, zorder=1, scalex=False, **FRONT_LINE)


def _style_axes(axes: Any, panel: Panel) -> None:
    style_log_axes(axes, panel.axis)
    axes.xaxis.set_major_formatter(lambda value, _: format_time(value))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}" if value > MIN_ERROR else f"≤ {value:g}")


def _colours(chart: Chart) -> dict[str, str]:
    return family_colours(result.family for result in chart.results)


def drawn_results(panel: Panel, chart: Chart) -> list[tuple[int, MethodResult]]:
    """Drawn results with their rows; cubes of this package first, so that all others are drawn above them."""
    found = [
        (row, result) for row, result in enumerate(chart.results) if result in chart.measured and panel.point(result)
    ]
    groups: dict[tuple[str, str], list[tuple[int, MethodResult]]] = {}
    for row, result in found:
        if result.build:
            groups.setdefault((result.family, result.mode), []).append((row, result))
    ours = [pair for group in groups.values() for pair in _unbeaten(panel, group)]
    return [*ours, *(pair for pair in found if not pair[1].build)]


def _unbeaten(panel: Panel, pairs: list[tuple[int, MethodResult]]) -> list[tuple[int, MethodResult]]:
    points = np.array([panel.point(result) for _, result in pairs])
    return [pairs[row] for row in pareto_front(points, CLEAR_RATIO)]


def _draw_result(
    axes: Any, panel: Panel, result: MethodResult, identifier: str, colour: str, *, on_front: bool
) -> None:
    time, mean = panel.point(result) or (1, 1)
    single = result.numbers[f"ns_{panel.batch}_colours"] < panel.batch
    if panel.whiskers:
        p99, largest = panel.whisker(result)
        style = WHISKER | {"color": colour, "alpha": 0.8 if on_front else 0.22, "zorder": 1.5}
        axes.plot([time, time], [mean, p99], gid=f"whisker-{identifier}", **style)
        axes.plot([time, time], [p99, largest], gid=f"whisker-{identifier}", **style | {"linewidth": 0.6})
    style = {
        **marker_style(result.mode if result.build else ""),
        "color": colour,
        "markeredgecolor": colour if single else "white",
        "markeredgewidth": 0.5,
    } | (SINGLE if single else {})
    axes.plot(time, mean, gid=f"marker-{identifier}", zorder=3 if on_front else 2, **style)


def _front_line(axes: Any, panel: Panel, chart: Chart) -> Array:
    """The Pareto front (k, 2) as a staircase."""
    points = np.array([panel.point(result) for result in panel.front(chart)]).reshape(-1, 2)
    return pareto_steps(points, axes.get_xlim()[1])


def label_panel(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    """Label the methods on the front and all that are not cubes of this package."""
    front, drawn, colours = panel.front(chart), drawn_results(panel, chart), _colours(chart)
    labels = [
        Label(
            result.label,
            panel.point(result) or (1, 1),
            colours[result.family],
            bold=result in front,
            gid=f"label-{number}-{row}",
        )
        for row, result in drawn
        if result in front or not result.build
    ]
    markers = np.array([panel.point(result) for _, result in drawn], dtype=float)
    draw_labels(axes, labels, markers, _front_line(axes, panel, chart))
