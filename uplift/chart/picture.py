"""The chart as a figure: a panel for each error, a marker for each method."""

from __future__ import annotations

import math
import os
from itertools import pairwise
from typing import Any

import numpy as np

from uplift.chart.labels import place
from uplift.chart.legend import ALONE, FRONT, OTHER, SHAPES, WHISKER, colours, legend, width
from uplift.chart.numbers import time_told
from uplift.chart.panels import AXES, FLOORS, LEAST, PANELS, Panel
from uplift.chart.table import Chart, Row
from uplift.files import write_text
from uplift.report.charts import GREY, INK, PALE, STYLE, svg
from uplift.report.figure import new_figure, write_png
from uplift.report.markup import Markup
from uplift.sensor import Array

COLUMNS, PANEL = 2, (6.6, 4.3)
"""Panels side by side, and inches of each."""
MARGINS = {"left": 0.066, "right": 0.985, "bottom": 0.03, "top": 0.98, "wspace": 0.13, "hspace": 0.24}
"""Shares of the figure, and of a panel."""
POINTS = 72
"""An inch, whatever the resolution."""
BEHIND = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.6}
"""A label on top of a crowd can still be read."""
LED = 14
"""Points from a marker beyond which a line leads to its label."""

Path = str | os.PathLike[str]


def write_pictures(chart: Chart, png: Path, vector: Path, *, force: bool = False) -> Markup:
    """The same picture as PNG and as SVG, whose text is returned for a page. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = draw(chart)
        write_png(figure, png, force=force)
        text = svg(figure)
    write_text(text, vector, force=force)
    return text


def draw(chart: Chart) -> Any:
    """A matplotlib figure. What stands for a method has the name ``<part>-<panel>-<row>``: marker, whisker, label."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    rows = math.ceil((len(PANELS) + 1) / COLUMNS)
    figure = new_figure(COLUMNS * PANEL[0], rows * PANEL[1], layout=None)
    figure.subplots_adjust(**MARGINS)
    FigureCanvasAgg(figure)
    cells = figure.subplots(rows, COLUMNS).ravel()
    for number, (axes, panel) in enumerate(zip(cells, PANELS, strict=False)):
        _draw_panel(axes, panel, chart, number)
    for axes in cells[len(PANELS) :]:
        axes.set_axis_off()
    legend(cells[len(PANELS)], chart)
    for number, (axes, panel) in enumerate(zip(cells, PANELS, strict=False)):
        _label(axes, panel, chart, number)
    return figure


def _draw_panel(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    _set_up(axes, panel)
    front = panel.front(chart)
    for row_number, row in _drawn(panel, chart):
        color = colours().get(row.family, OTHER)
        _draw_row(axes, panel, row, f"{number}-{row_number}", color=color, ahead=row in front)
    axes.margins(0.06)
    if front:
        axes.plot(*_stairs(axes, panel, chart).T, zorder=1, scalex=False, **FRONT)


def _set_up(axes: Any, panel: Panel) -> None:
    from matplotlib.ticker import LogLocator

    axes.set(xscale="log", yscale="log", xlabel=AXES[panel.across])
    axes.set_title(f"{panel.title}, {panel.unit}", loc="left", fontsize=11, fontweight="bold", color=INK)
    axes.xaxis.set_major_formatter(lambda value, _: _time(panel, value))
    axes.yaxis.set_major_locator(LogLocator(subs=(1,) if panel.whiskers else (1, 2, 5)))
    axes.minorticks_off()
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}" if value > LEAST else f"≤ {value:g}")
    axes.grid(color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _time(panel: Panel, value: float) -> str:
    if panel.across == "time_ns":
        return time_told(value)
    return time_told(value * 1e9) if value > FLOORS["build_s"] else "nothing\nto build"


def _drawn(panel: Panel, chart: Chart) -> list[tuple[int, Row]]:
    """Rows with their numbers, ours first and so below the others."""
    rows = [
        (number, row) for number, row in enumerate(chart.rows) if row in chart.measured and panel.point(row)
    ]
    return sorted(rows, key=lambda pair: not pair[1].build)


def _draw_row(axes: Any, panel: Panel, row: Row, name: str, *, color: str, ahead: bool) -> None:
    (x, mean), alone = panel.point(row) or (1, 1), "batch_ns" not in row.numbers
    if panel.whiskers:
        p99, most = panel.reach(row)
        thin = {
            **WHISKER,
            "color": color,
            "alpha": 0.8 if ahead else 0.22,
            "gid": f"whisker-{name}",
            "zorder": 1.5,
        }
        axes.plot([x, x], [mean, p99], **thin)
        axes.plot([x, x], [p99, most], **{**thin, "linewidth": 0.6})
    axes.plot(
        x,
        mean,
        gid=f"marker-{name}",
        zorder=3 if ahead else 2,
        alpha=1 if ahead or not row.build else 0.75,
        **{
            "marker": SHAPES.get(row.mode, "o"),
            "markersize": width(row.numbers["bytes"]),
            "color": color,
            "markeredgecolor": color if alone else "white",
            "markeredgewidth": 0.5,
            **(ALONE if alone else {}),
        },
    )


def _stairs(axes: Any, panel: Panel, chart: Chart) -> Array:
    """The Pareto front (k, 2) as a staircase: who stands above it is beaten in both respects."""
    points = np.array([panel.point(row) for row in panel.front(chart)]).reshape(-1, 2)
    x = np.append(points[:, 0].repeat(2)[1:], axes.get_xlim()[1])
    return np.stack([x, points[:, 1].repeat(2)], axis=1)


def _label(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    """Names of what is on the front, and of all that is not ours."""
    front, drawn = panel.front(chart), _drawn(panel, chart)
    named = [(row_number, row) for row_number, row in drawn if row in front or not row.build]
    if not named:
        return
    scale, known = POINTS / axes.figure.dpi, colours()
    line = np.concatenate([np.geomspace(*pair, 40) for pair in pairwise(_stairs(axes, panel, chart))])
    anchors, markers, line = (
        scale * axes.transData.transform(points)
        for points in ([panel.point(row) for _, row in named], [panel.point(row) for _, row in drawn], line)
    )
    texts = [
        axes.annotate(
            row.label,
            (0, 0),
            xycoords="figure points",
            fontsize=7.5,
            fontweight="bold" if row in front else "normal",
            color=known.get(row.family, OTHER),
            gid=f"label-{number}-{row_number}",
            bbox=BEHIND,
        )
        for row_number, row in named
    ]
    renderer = axes.figure.canvas.get_renderer()
    sizes = scale * np.array([text.get_window_extent(renderer).size for text in texts])
    within = scale * axes.get_window_extent(renderer).extents
    corners = place(anchors, sizes, np.concatenate([markers, line]), within)
    for text, corner, size, anchor in zip(texts, corners, sizes, anchors, strict=True):
        text.set_position(corner)
        text.xy = tuple(corner)
        _lead(axes, np.clip(anchor, corner, corner + size), anchor)


def _lead(axes: Any, end: Array, start: Array) -> None:
    if np.linalg.norm(end - start) > LED:
        style = {"arrowstyle": "-", "color": GREY, "linewidth": 0.5}
        there = {"xycoords": "figure points", "textcoords": "figure points"}
        axes.annotate("", end, start, arrowprops=style, zorder=1, **there)
