"""Panels of error over cost on logarithmic axes: markers with labels and the Pareto
front, for figures and pages.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array, StrPath
from uplift.extras.pages.figure import (
    GREY,
    INK,
    OTHER,
    figure_text,
    new_figure,
    style_axes,
    styled,
    to_page_svg,
    write_png,
)
from uplift.extras.pages.scatter import LEGEND, Label, draw_labels, style_title

CLEAR_RATIO = 0.99
"""Share of an error below which another one is clearly smaller; the rest is noise."""
SIZE = (4.8, 3.4)
"""Inches of a panel."""
FRONT_LINE: dict[str, Any] = {"color": INK, "linewidth": 1.1, "marker": ""}
MARKER_SIZES = {"*": 9.5, "D": 5.5}
"""Points; others are 6.5 wide."""


@dataclass(frozen=True)
class Point:
    """A marker in a panel.

    ``row``: its row in the tooltips of a page.
    ``label``: its name, written next to it if it is on the front or ``named``.
    ``colour``, ``marker``: ``#rrggbb``, and the name of a marker of matplotlib.
    ``hollow``: whether it is not filled.
    ``group``: markers of one group are joined by a line, in order.
    """

    row: int
    label: str
    cost: float
    error: float
    colour: str
    marker: str = "o"
    hollow: bool = False
    named: bool = True
    group: str = ""


@dataclass(frozen=True)
class Panel:
    """Points over a kind of cost, of which ``axis`` is the label, and ``format`` the
    text of a value.
    """

    title: str
    axis: str
    format: Callable[[float], str]
    points: Sequence[Point]


def family_colours(families: Iterable[str], known: Mapping[str, str]) -> dict[str, str]:
    """``#rrggbb`` of families in the order of the known ones; others are dark grey."""
    present = dict.fromkeys(families)
    return {
        name: known.get(name, OTHER)
        for name in sorted(present, key=[*known, *sorted(present)].index)
    }


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Return the rows of cost and error whose error is clearly below that of every
    cheaper one, cheapest first.
    """
    front: list[int] = []
    for row in sorted(range(len(points)), key=points.__getitem__):
        if not front or points[row][1] < CLEAR_RATIO * points[front[-1]][1]:
            front.append(row)
    return front


def write_panels(
    panels: Sequence[Panel],
    columns: int,
    path: StrPath,
    legend: Mapping[str, Mapping[str, Any]],
    *,
    force: bool = False,
) -> None:
    """Write panels as PNG, with a legend of styles by name. Raises `OutputError`."""
    with styled():
        write_png(panel_figure(panels, columns, legend), path, force=force)


def page_panel(panel: Panel, number: int) -> Markup:
    """Draw a panel for a page, whose titles are in its text. The artists are named
    ``marker-<number>-<row>`` etc.
    """
    with styled():
        return to_page_svg(
            panel_figure([panel], 1, titles=False, first=number),
            f"{panel.title}, over {panel.axis}",
        )


def panel_figure(
    panels: Sequence[Panel],
    columns: int,
    legend: Mapping[str, Mapping[str, Any]] | None = None,
    *,
    titles: bool = True,
    first: int = 0,
) -> Any:
    """Return the matplotlib figure of panels in rows."""
    from matplotlib.lines import Line2D

    rows = math.ceil(len(panels) / columns)
    legend_rows = math.ceil(len(legend or ()) / (2 * columns))
    figure = new_figure(columns * SIZE[0], rows * SIZE[1] + legend_rows * 0.2)
    cells = figure.subplots(rows, columns, squeeze=False).ravel()
    for number, (axes, panel) in enumerate(zip(cells, panels, strict=True), first):
        _draw_panel(axes, panel, number)
        if titles:
            style_title(axes, panel.title)
    if legend:
        legend = {**legend, "Pareto front": {**FRONT_LINE, "linestyle": "-"}}
        handles = [
            Line2D([], [], **{"linestyle": "", "color": GREY, "marker": "o", **style})
            for style in legend.values()
        ]
        figure.legend(
            handles,
            map(figure_text, legend),
            loc="outside lower left",
            ncols=2 * columns,
            **LEGEND,
        )
    fix_layout(figure)
    for number, (axes, panel) in enumerate(zip(cells, panels, strict=True), first):
        _label_panel(axes, panel, number)
    return figure


def fix_layout(figure: Any) -> None:
    """Fix the positions of the axes; then labels are placed where there is room."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _draw_panel(axes: Any, panel: Panel, number: int) -> None:
    axes.set(xscale="log", yscale="log", xlabel=panel.axis)
    axes.minorticks_off()
    style_axes(axes)
    _draw_whiskers(axes, panel, number)
    front = _front(panel)
    for point in panel.points:
        face, edge = (
            ("white", point.colour) if point.hollow else (point.colour, "white")
        )
        axes.plot(
            point.cost,
            point.error,
            gid=f"marker-{number}-{point.row}",
            zorder=3 if point in front else 2,
            marker=point.marker,
            markersize=MARKER_SIZES.get(point.marker, 6.5),
            color=point.colour,
            markerfacecolor=face,
            markeredgecolor=edge,
            markeredgewidth=1.2 if point.hollow else 0.5,
        )
    axes.margins(0.06)
    _set_ticks(axes.xaxis, panel.format)
    _set_ticks(axes.yaxis, "{:g}".format)
    axes.plot(*_staircase(axes, panel).T, zorder=1, scalex=False, **FRONT_LINE)


def _draw_whiskers(axes: Any, panel: Panel, number: int) -> None:
    """Draw a line through the points of each group."""
    for group in dict.fromkeys(point.group for point in panel.points if point.group):
        members = [point for point in panel.points if point.group == group]
        first = members[0]
        axes.plot(
            *_places(members).T,
            gid=f"whisker-{number}-{first.row}",
            color=first.colour,
            linewidth=0.8,
            alpha=0.45,
            zorder=1,
        )


def _set_ticks(axis: Any, text: Callable[[float], str]) -> None:
    """Ticks at powers of ten and, on axes of few decades, between them."""
    from matplotlib.ticker import LogLocator

    low, high = sorted(axis.get_view_interval())
    axis.set_major_locator(
        LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,), numticks=40)
    )
    axis.set_major_formatter(lambda value, _: text(value))


def _places(points: Sequence[Point]) -> Array:
    """Return the costs and errors (n, 2) of points."""
    places = [(point.cost, point.error) for point in points]
    return np.array(places).reshape(-1, 2)


def _front(panel: Panel) -> list[Point]:
    rows = pareto_front(_places(panel.points).tolist())
    return [panel.points[row] for row in rows]


def _staircase(axes: Any, panel: Panel) -> Array:
    """Corners (2 k, 2) of the Pareto front, up to the right end of the axes."""
    front = _places(_front(panel))
    x = np.append(front[:, 0].repeat(2)[1:], axes.get_xlim()[1])[: 2 * len(front)]
    return np.stack([x, front[:, 1].repeat(2)], axis=1)


def _label_panel(axes: Any, panel: Panel, number: int) -> None:
    front = _front(panel)
    labels = [
        Label(
            point.label,
            (point.cost, point.error),
            point.colour,
            point in front,
            f"label-{number}-{point.row}",
        )
        for point in panel.points
        if point.named or point in front
    ]
    draw_labels(axes, labels, _places(panel.points), _staircase(axes, panel))
