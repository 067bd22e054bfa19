"""Figures of panels: a panel has marks, dots with labels that cover nothing, and two
axes; a figure has panels in rows, one legend and one scale of errors.
"""

import io
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Any, Literal

import numpy as np

from uplift.extras.pages.figure import (
    GREY,
    INK,
    figure_text,
    new_figure,
    style_axes,
    styled,
)
from uplift.extras.pages.marks import Mark

MARKER_SIZES = {"*": 9.5, "D": 5.5}
"""Points; others are 6.5 wide."""
LABEL_SIZE = 7.5
"""Points of the font of labels."""
CLEARANCE = 4.0
"""Points that labels keep from the middle of markers."""
DISTANCES = (5.0, 42.0)
"""Smallest and largest distance in points between a dot and its label."""
LEADER = 9.0
"""Distance in points from which a line joins a dot and its label."""
TEXT_HEIGHT = 0.19
"""Inches of a line of text above or below a picture."""
LEGEND: dict[str, Any] = {"frameon": False, "fontsize": 8}


@dataclass(frozen=True)
class Axis:
    """An axis: its label, scale and limits, and the text of a value.

    ``names`` stand at 0, 1, … instead of values, on a vertical axis from the top.
    """

    label: str = ""
    log: bool = False
    limits: tuple[float | None, float | None] = (None, None)
    text: Callable[[float], str] | None = None
    names: Sequence[str] = ()
    ticks: Sequence[float] = ()


@dataclass(frozen=True)
class Dot:
    """A marker at (x, y), and the text next to it.

    ``marker`` is the name of one of matplotlib, ``key`` identifies the marker and its
    text in SVG as ``marker-KEY`` and ``label-KEY``. Bold texts are placed first; a text
    without room is left out.
    """

    x: float
    y: float
    text: str = ""
    colour: str = INK
    marker: str = "o"
    hollow: bool = False
    bold: bool = False
    key: str = ""


@dataclass(frozen=True, eq=False)
class Panel:
    """Marks and dots under a title. ``legend`` is the place of a legend in the panel,
    by matplotlib's names.
    """

    marks: Sequence[Mark] = ()
    title: str = ""
    x: Axis = Axis()
    y: Axis = Axis()
    dots: Sequence[Dot] = ()
    legend: str = ""


def draw(
    panels: Sequence[Panel | None],
    columns: int = 1,
    size: tuple[float, float] | float = (3.6, 2.7),
    *,
    legend: Literal["", "above", "below"] = "",
    title: str = "",
    scale: str = "ΔE00",
    dpi: float = 130,
    share: str = "",
) -> Any:
    """Return the figure of matplotlib with panels in rows of ``columns``.

    Parameters
    ----------
    panels
        None is an empty place.
    size
        Inches of a panel, or the width alone of a picture, whose height follows. Pages
        are about 7.2 inches wide.
    legend
        Place of one legend for all labels of the marks.
    scale
        Label of the scale of all `error_map`.
    share
        ``"x"``, ``"y"`` or ``"xy"``: axes that have the same limits in all panels.
    """
    rows = math.ceil(len(panels) / columns)
    width, height = (size, 1.0) if isinstance(size, float | int) else size
    with styled():
        figure = new_figure(columns * width, rows * height)
        figure.set_dpi(dpi)
        cells = figure.subplots(
            rows, columns, squeeze=False, sharex="x" in share, sharey="y" in share
        )
        drawn = []
        for axes, panel in zip_longest(cells.flat, panels):
            if panel is None:
                axes.set_axis_off()
            else:
                drawn.append((axes, panel))
        for axes, panel in drawn:
            _draw_panel(axes, panel)
        for axes, panel in drawn:
            _set_axis(axes.xaxis, panel.x)
            _set_axis(axes.yaxis, panel.y)
        if "x" in share:
            _remove_labels(cells[:-1], "x")
        if "y" in share:
            _remove_labels(cells[:, 1:], "y")
        if isinstance(size, float | int):
            _fit_heights(figure, cells, width)
        _add_scale(figure, cells, scale)
        if title:
            figure.suptitle(figure_text(title), fontsize=9, color=INK)
        if legend:
            _add_legend(figure, cells, legend, columns)
        _fix_layout(figure)
        for axes, panel in drawn:
            _write_labels(axes, panel.dots)
    return figure


def sheet(titles: Sequence[str], rows: Mapping[str, Sequence[Panel]]) -> list[Panel]:
    """Return the panels of a sheet: titles above its columns, and names of its rows."""
    panels = []
    for number, (name, row) in enumerate(rows.items()):
        for column, panel in enumerate(row):
            if number == 0:
                panel = replace(panel, title=titles[column])
            if column == 0:
                panel = replace(panel, y=Axis(name))
            panels.append(panel)
    return panels


def _remove_labels(cells: Any, name: str) -> None:
    """Remove the labels of axes that have the limits of others."""
    for axes in cells.flat:
        axes.set(**{f"{name}label": ""})


def _draw_panel(axes: Any, panel: Panel) -> None:
    for name, axis in (("x", panel.x), ("y", panel.y)):
        if axis.log:
            axes.set(**{f"{name}scale": "log"})
    if panel.dots:
        style_axes(axes)
        axes.margins(0.06)
    for dot in panel.dots:
        _draw_dot(axes, dot)
    for mark in panel.marks:
        mark(axes)
    if panel.title:
        axes.set_title(
            figure_text(panel.title),
            loc="left",
            fontsize=8.5,
            fontweight="bold",
            color=INK,
        )
    if panel.legend:
        axes.legend(loc=panel.legend, **LEGEND)


def _draw_dot(axes: Any, dot: Dot) -> None:
    face, edge = ("white", dot.colour) if dot.hollow else (dot.colour, "white")
    axes.plot(
        dot.x,
        dot.y,
        gid=f"marker-{dot.key}" if dot.key else None,
        zorder=3 if dot.bold else 2,
        linestyle="",
        marker=dot.marker,
        markersize=MARKER_SIZES.get(dot.marker, 6.5),
        markerfacecolor=face,
        markeredgecolor=edge,
        markeredgewidth=1.2 if dot.hollow else 0.5,
        clip_on=False,
    )


def _set_axis(axis: Any, wanted: Axis) -> None:
    from matplotlib.ticker import LogLocator

    low, high = wanted.limits
    axis.set_label_text(figure_text(wanted.label))
    if low is not None or high is not None:
        now = axis.get_view_interval()
        limits = [now[0] if low is None else low, now[1] if high is None else high]
        axis.axes.set(**{f"{axis.axis_name}lim": limits})
    if wanted.names:
        axis.set_ticks(range(len(wanted.names)), list(map(figure_text, wanted.names)))
        axis.set_view_interval(len(wanted.names) - 0.5, -0.5, ignore=True)
        return
    if wanted.log:
        low, high = sorted(axis.get_view_interval())
        # Axes of few decades have ticks between the powers of ten.
        steps = (1, 2, 5) if high < 1000 * low else (1,)
        axis.set_major_locator(LogLocator(subs=steps, numticks=40))
        axis.set_minor_locator(LogLocator(subs=()))
    if wanted.ticks:
        axis.set_ticks(list(wanted.ticks))
    if wanted.log or wanted.text:
        text = wanted.text or "{:g}".format
        axis.set_major_formatter(lambda value, _: text(value))


def _fit_heights(figure: Any, cells: Any, width: float) -> None:
    """Give rows the heights of their pictures and texts."""
    heights = [max(_height(axes, width) for axes in row) for row in cells]
    cells[0, 0].get_gridspec().set_height_ratios(heights)
    figure.set_size_inches(figure.get_size_inches()[0], sum(heights))


def _height(axes: Any, width: float) -> float:
    """Return the inches that the picture of a panel takes, if any, and its texts."""
    texts = (axes.get_title(loc="left"), axes.get_xlabel())
    lines = sum(text.count("\n") + 1 for text in texts if text)
    shapes = [image.get_size() for image in axes.images] or [(1, 3)]
    return width * shapes[0][0] / shapes[0][1] + lines * TEXT_HEIGHT


def _add_scale(figure: Any, cells: Any, label: str) -> None:
    """Draw one scale of all maps of errors, right of the last column."""
    maps = [
        image for axes in cells.flat for image in axes.images if image.norm.scaled()
    ]
    maps = [image for image in maps if image.get_array().ndim == 2]
    if maps:
        bar = figure.colorbar(
            maps[0], ax=list(cells[:, -1]), fraction=0.05, pad=0.02, extend="max"
        )
        bar.set_label(label, color=INK)
        bar.outline.set_visible(False)


def _add_legend(figure: Any, cells: Any, place: str, columns: int) -> None:
    handles: dict[str, Any] = {}
    for axes in cells.flat:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    side = {"above": "outside upper center", "below": "outside lower center"}[place]
    count = min(len(handles), max(2 * columns, 4))
    figure.legend(handles.values(), handles, loc=side, ncols=count, **LEGEND)


def _fix_layout(figure: Any) -> None:
    """Fix the positions of the axes; then labels are placed where there is room."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _write_labels(axes: Any, dots: Sequence[Dot]) -> None:
    """Write the texts of dots that have room, bold ones first."""
    named = sorted((dot for dot in dots if dot.text), key=lambda dot: not dot.bold)
    if not named:
        return
    import textalloc

    point = axes.figure.dpi / 72
    width = axes.get_window_extent().width
    nearest, farthest = np.multiply(DISTANCES, point / width)
    curves = [curve.get_xydata().T for curve in axes.lines if _is_curve(curve)]
    axes.autoscale(enable=False)
    # It prints a line if no text has room.
    with redirect_stdout(io.StringIO()):
        _, _, texts, leaders = textalloc.allocate(
            axes,
            [dot.x for dot in named],
            [dot.y for dot in named],
            [figure_text(dot.text) for dot in named],
            x_scatter=[dot.x for dot in dots],
            y_scatter=[dot.y for dot in dots],
            scatter_sizes=[CLEARANCE * point] * len(dots),
            x_lines=[x for x, _ in curves] or None,
            y_lines=[y for _, y in curves] or None,
            textsize=LABEL_SIZE,
            fontweight=["bold" if dot.bold else "normal" for dot in named],
            textcolor=[dot.colour for dot in named],
            linecolor=GREY,
            linewidth=0.5,
            margin=0.003,
            min_distance=nearest,
            max_distance=farthest,
            nbr_candidates=1000,
            draw_all=False,
            va="bottom",
        )
    for dot, text, leader in zip(named, texts, leaders, strict=True):
        if text is not None and dot.key:
            text.set_gid(f"label-{dot.key}")
        if leader is not None and _length(leader) < LEADER * point:
            leader.remove()


def _is_curve(line: Any) -> bool:
    """Whether a line joins points: markers and thresholds do not."""
    is_joined = line.get_linestyle() != "None" and len(line.get_xydata()) > 1
    return is_joined and line.get_transform() == line.axes.transData


def _length(line: Any) -> float:
    """Return the length of a straight line in pixels."""
    first, last = line.axes.transData.transform(line.get_xydata())
    return float(np.hypot(*(last - first)))


def spectra_panel(marks: Sequence[Mark], title: str = "", top: float = 1.02) -> Panel:
    """Return a panel of reflectances up to ``top`` over wavelength, with a legend."""
    x = Axis("wavelength / nm")
    y = Axis("reflectance", limits=(-0.02, top))
    return Panel(marks, title, x, y, legend="best")
