"""The chart as a figure: a panel for each error, a marker for each method."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.common.files import write_text
from uplift.lab.chart.legend import ALONE, FRONT, OTHER, SHAPES, WHISKER, colours, legend, width
from uplift.lab.chart.panels import AXES, FLOORS, LEAST, PANELS, Panel
from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.figure import STYLE, new_figure, to_svg, write_png
from uplift.viz.format import format_time
from uplift.viz.markup import Markup
from uplift.viz.scatter import Name, label, pareto_steps, set_up

COLUMNS, PANEL = 2, (6.6, 4.3)
"""Panels side by side, and inches of each."""
MARGINS = {"left": 0.066, "right": 0.985, "bottom": 0.03, "top": 0.98, "wspace": 0.13, "hspace": 0.24}
"""Shares of the figure, and of a panel."""

Path = str | os.PathLike[str]


def write_pictures(chart: Chart, png: Path, vector: Path, *, force: bool = False) -> Markup:
    """The same picture as PNG and as SVG, whose text is returned for a page. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = draw(chart)
        write_png(figure, png, force=force)
        text = to_svg(figure)
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

    set_up(axes, f"{panel.title}, {panel.unit}", AXES[panel.across])
    axes.xaxis.set_major_formatter(lambda value, _: _time(panel, value))
    axes.yaxis.set_major_locator(LogLocator(subs=(1,) if panel.whiskers else (1, 2, 5)))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}" if value > LEAST else f"≤ {value:g}")


def _time(panel: Panel, value: float) -> str:
    if panel.across == "time_ns":
        return format_time(value)
    return format_time(value * 1e9) if value > FLOORS["build_s"] else "nothing\nto build"


def _drawn(panel: Panel, chart: Chart) -> list[tuple[int, MethodResult]]:
    """Rows with their numbers, ours first and so below the others."""
    rows = [
        (number, row) for number, row in enumerate(chart.rows) if row in chart.measured and panel.point(row)
    ]
    return sorted(rows, key=lambda pair: not pair[1].build)


def _draw_row(axes: Any, panel: Panel, row: MethodResult, name: str, *, color: str, ahead: bool) -> None:
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
    """The Pareto front (k, 2) as a staircase."""
    points = np.array([panel.point(row) for row in panel.front(chart)]).reshape(-1, 2)
    return pareto_steps(points, axes.get_xlim()[1])


def _label(axes: Any, panel: Panel, chart: Chart, number: int) -> None:
    """Names of what is on the front, and of all that is not ours."""
    front, drawn = panel.front(chart), _drawn(panel, chart)
    known = colours()
    names = [
        Name(
            row.label,
            panel.point(row) or (1, 1),
            known.get(row.family, OTHER),
            bold=row in front,
            gid=f"label-{number}-{row_number}",
        )
        for row_number, row in drawn
        if row in front or not row.build
    ]
    markers = np.array([panel.point(row) for _, row in drawn], dtype=float)
    label(axes, names, markers, _stairs(axes, panel, chart))
