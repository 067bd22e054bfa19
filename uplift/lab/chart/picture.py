"""The chart as a figure with a panel for each error, and as single panels for a page.

Of the cubes of this package a panel shows those that no other cube of the same kind and mode beats.
"""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.common.files import write_text
from uplift.lab.chart.legend import SINGLE, WHISKER, draw_legend, draw_shapes, family_colours, marker_style
from uplift.lab.chart.panels import AXES, CLEAR_RATIO, MIN_ERROR, MIN_TIMES, PANELS, Panel
from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.figure import STYLE, to_page_svg, to_svg, write_png
from uplift.viz.format import format_time
from uplift.viz.scatter import (
    FRONT_LINE,
    Label,
    draw_labels,
    new_panels,
    pareto_front,
    pareto_steps,
    set_log_ticks,
    style_log_axes,
    style_title,
)

COLUMNS, PANEL_SIZE = 2, (6.6, 4.3)
"""Panels in a row, and inches of each."""
MARGINS = {"left": 0.066, "right": 0.985, "bottom": 0.03, "top": 0.98, "wspace": 0.13, "hspace": 0.24}
PAGE_PANEL_SIZE = (4.1, 3.0)
"""Inches of a panel of a page, where it is about as wide on a desk as on a phone."""
PAGE_MARGINS = {"left": 0.115, "right": 0.97, "bottom": 0.165, "top": 0.99}
KEY_SIZE = (4.1, 2.15)
"""Inches of the legend of a page."""

Path = str | os.PathLike[str]


def write_pictures(chart: Chart, png: Path, svg: Path, *, force: bool = False) -> None:
    """Write the figure of a chart as PNG and as SVG.

    Parameters
    ----------
    chart : Chart
        The chart.
    png, svg : path-like
        The files to write.
    force : bool, default False
        Replace existing files.

    Raises
    ------
    OutputError
        If a file exists and ``force`` is false, or cannot be written.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = draw(chart)
        write_png(figure, png, force=force)
        element = to_svg(figure, "Error over time of all methods, a panel for each error")
    write_text(element, svg, force=force)


def page_panels(chart: Chart) -> list[tuple[str, Markup]]:
    """Draw the panels of a chart one by one for a page.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    list of tuple
        Title and ``svg`` element of every panel, and at the end of the legend of shapes.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        panels = [(_title(panel), _page_panel(panel, chart, number)) for number, panel in enumerate(PANELS)]
        return [*panels, ("Shapes and lines", _page_key(chart))]


def draw(chart: Chart) -> Any:
    """Return the matplotlib figure; its artists are named ``marker-<panel>-<row>``, ``whisker-…`` and ``label-…``."""
    figure, cells = new_panels(math.ceil((len(PANELS) + 1) / COLUMNS), COLUMNS, PANEL_SIZE, MARGINS)
    cells = cells.ravel()
    for number, (axes, panel) in enumerate(zip(cells, PANELS, strict=False)):
        _draw_panel(axes, panel, chart, number)
        style_title(axes, _title(panel))
    for axes in cells[len(PANELS) :]:
        axes.set_axis_off()
    draw_legend(cells[len(PANELS)], chart)
    for number, (axes, panel) in enumerate(zip(cells, PANELS, strict=False)):
        _draw_labels(axes, panel, chart, number)
    return figure


def _title(panel: Panel) -> str:
    return f"{panel.title}, {panel.unit}"


def _page_panel(panel: Panel, chart: Chart, number: int) -> Markup:
    figure, cells = new_panels(1, 1, PAGE_PANEL_SIZE, PAGE_MARGINS)
    axes = cells[0, 0]
    for background in (figure.patch, axes.patch):
        background.set_visible(False)
    _draw_panel(axes, panel, chart, number)
    _draw_labels(axes, panel, chart, number)
    return to_page_svg(figure, f"{_title(panel)}, over {AXES[panel.time]}")


def _page_key(chart: Chart) -> Markup:
    figure, cells = new_panels(1, 1, KEY_SIZE, {"left": 0, "right": 1, "bottom": 0, "top": 1})
    figure.patch.set_visible(False)
    cells[0, 0].set_axis_off()
    draw_shapes(cells[0, 0], chart, (0.0, 1.0))
    return to_page_svg(figure, "Meanings of shapes and lines")


def _draw_panel(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    _style_axes(axes, panel)
    front, colours = panel.front(chart), _colours(chart)
    for row, result in _drawn(panel, chart):
        _draw_result(axes, panel, result, f"{number}-{row}", colours[result.family], on_front=result in front)
    axes.margins(0.06)
    set_log_ticks(axes.yaxis)
    if front:
        axes.plot(*_front_line(axes, panel, chart).T, zorder=1, scalex=False, **FRONT_LINE)


def _style_axes(axes: Any, panel: Panel) -> None:
    style_log_axes(axes, AXES[panel.time])
    axes.xaxis.set_major_formatter(lambda value, _: _time_label(panel, value))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}" if value > MIN_ERROR else f"≤ {value:g}")


def _time_label(panel: Panel, value: float) -> str:
    if panel.time == "time_ns":
        return format_time(value)
    return format_time(value * 1e9) if value > MIN_TIMES["build_s"] else "nothing\nto build"


def _colours(chart: Chart) -> dict[str, str]:
    return family_colours(result.family for result in chart.results)


def _drawn(panel: Panel, chart: Chart) -> list[tuple[int, MethodResult]]:
    """Drawn results with their rows; cubes of this package first, so that all others are drawn above them."""
    found = [
        (row, result)
        for row, result in enumerate(chart.results)
        if result in chart.measured and panel.point(result)
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
    single = "batch_ns" not in result.numbers
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


def _draw_labels(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    """Label the methods on the front and all that are not cubes of this package."""
    front, drawn, colours = panel.front(chart), _drawn(panel, chart), _colours(chart)
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
