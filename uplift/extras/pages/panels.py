"""Figures of panels: a panel has marks, dots with labels that cover nothing, and two
axes; a figure has panels in rows, one legend and one scale of errors.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Any, Literal

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.extras.pages.dots import Dot, draw_dot, write_labels
from uplift.extras.pages.figure import (
    INK,
    figure_text,
    matplotlib,
    style_axes,
    styled,
    to_page_svg,
)
from uplift.extras.pages.marks import Mark

__all__ = [
    "Axis",
    "Dot",
    "Panel",
    "draw",
    "page_svg",
    "sheet",
    "spectra_panel",
    "square_limits",
]

PAGE_SIZE = (4.8, 3.4)
"""Inches of a panel on a page."""
MARGIN = 0.06
"""Space around dots and regions, as a share of their extent."""
TEXT_HEIGHT = 0.19
"""Inches of a line of text above or below a picture."""
ENTRY = 0.5
LETTER = 0.06
"""Inches of an entry of a legend without its text, and of a letter."""
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
    scale: str | None = "ΔE00",
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
        Label of the scales of all `error_map`; None for none.
    share
        ``"x"``, ``"y"`` or ``"xy"``: axes that have the same limits in all panels.
    """
    rows = math.ceil(len(panels) / columns)
    width, height = size if isinstance(size, tuple) else (size, 1.0)
    with styled():
        extent = columns * width, rows * height
        figure = matplotlib().figure.Figure(extent, dpi, layout="constrained")
        cells = figure.subplots(
            rows, columns, squeeze=False, sharex="x" in share, sharey="y" in share
        )
        drawn = []
        for axes, panel in zip_longest(cells.flat, panels):
            if panel is None:
                axes.set_axis_off()
            else:
                drawn.append((axes, panel))
                _draw_panel(axes, panel)
        for axes, panel in drawn:
            _set_axis(axes.xaxis, panel.x)
            _set_axis(axes.yaxis, panel.y)
        if "x" in share:
            for axes in cells[:-1].flat:
                axes.set_xlabel("")
        if "y" in share:
            for axes in cells[:, 1:].flat:
                axes.set_ylabel("")
        if not isinstance(size, tuple):
            _fit_heights(figure, cells, width)
        if scale is not None:
            _add_scales(figure, cells, scale)
        if title:
            figure.suptitle(figure_text(title), fontsize=9, color=INK)
        if legend:
            _add_legend(figure, cells, legend)
        _fix_layout(figure)
        for axes, panel in drawn:
            write_labels(axes, panel.dots)
    return figure


def page_svg(panel: Panel, size: tuple[float, float] = PAGE_SIZE) -> Markup:
    """Draw a panel as an ``svg`` element of a page, which has its title as text."""
    figure = draw([replace(panel, title="")], size=size)
    return to_page_svg(figure, f"{panel.title}, over {panel.x.label}")


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


def _draw_panel(axes: Any, panel: Panel) -> None:
    for name, axis in (("x", panel.x), ("y", panel.y)):
        if axis.log:
            axes.set(**{f"{name}scale": "log"})
    if panel.dots:
        style_axes(axes)
        axes.margins(MARGIN)
    for dot in panel.dots:
        draw_dot(axes, dot)
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
    if panel.legend and axes.get_legend_handles_labels()[1]:
        axes.legend(loc=panel.legend, **LEGEND)


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
        axis.set_major_locator(LogLocator(subs=steps, numticks=9))
        axis.set_minor_locator(LogLocator(subs=()))
    if wanted.ticks:
        axis.set_ticks(list(wanted.ticks))
    if wanted.log or wanted.text:
        text = wanted.text or "{:g}".format
        axis.set_major_formatter(lambda value, _: text(value))


def _fit_heights(figure: Any, cells: Any, width: float) -> None:
    """Give rows the heights of their pictures and texts."""
    heights = []
    for row in cells:
        heights.append(max(_height(axes, width) for axes in row))
    cells[0, 0].get_gridspec().set_height_ratios(heights)
    figure.set_size_inches(figure.get_size_inches()[0], sum(heights))


def _height(axes: Any, width: float) -> float:
    """Return the inches that the picture of a panel takes, if any, and its texts."""
    texts = (axes.get_title(loc="left"), axes.get_xlabel())
    lines = sum(text.count("\n") + 1 for text in texts if text)
    # Other panels, and stretched pictures, fill the height of their row.
    height, columns = 1, 3
    if axes.images and axes.get_aspect() != "auto":
        height, columns = axes.images[0].get_size()
    return width * height / columns + lines * TEXT_HEIGHT


def _add_scales(figure: Any, cells: Any, label: str) -> None:
    """Draw the scale of all maps right of the last column if they share it, and else
    that of each map next to it.
    """
    maps = []
    for axes in cells.flat:
        maps += [image for image in axes.images if image.get_array().ndim == 2]
    places = {image: image.axes for image in maps}
    if len({(type(image.norm), *image.get_clim()) for image in maps}) == 1:
        places = {maps[0]: list(cells[:, -1])}
    for image, axes in places.items():
        bar = figure.colorbar(image, ax=axes, fraction=0.05, pad=0.02, extend="max")
        bar.set_label(label, color=INK)
        bar.outline.set_visible(False)


def _add_legend(figure: Any, cells: Any, place: str) -> None:
    """Add the labels of all panels in as few lines of even length as they need."""
    handles: dict[str, Any] = {}
    for axes in cells.flat:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    side = {"above": "outside upper center", "below": "outside lower center"}[place]
    entry = ENTRY + LETTER * max(map(len, handles), default=0)
    lines = math.ceil(len(handles) * entry / figure.get_figwidth())
    count = math.ceil(len(handles) / max(lines, 1))
    figure.legend(handles.values(), handles, loc=side, ncols=count, **LEGEND)


def _fix_layout(figure: Any) -> None:
    """Fix the positions of the axes; then labels are placed where there is room."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    # The second time, as axes of another size may have other ticks.
    figure.draw_without_rendering()
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def spectra_panel(marks: Sequence[Mark], title: str = "", top: float = 1.02) -> Panel:
    """Return a panel of reflectances up to ``top`` over wavelength, with a legend."""
    x = Axis("wavelength / nm")
    y = Axis("reflectance", limits=(-0.02, top))
    return Panel(marks, title, x, y, legend="best")


def square_limits(points: Array, smallest: float) -> Array:
    """Return limits (2, 2) of x and y of a square around points (n, 2), whose side is
    ``smallest`` or more.
    """
    low = points.min(axis=0)
    high = points.max(axis=0)
    half = max(float((high - low).max()) * (0.5 + MARGIN), smallest / 2)
    middle = (low + high) / 2
    return np.stack([middle - half, middle + half], axis=1)
