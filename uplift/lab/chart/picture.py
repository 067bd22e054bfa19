"""The chart as a figure, a row of panels for each number of colours per call, and as single panels for a page."""

from __future__ import annotations

import os
from typing import Any

from markupsafe import Markup

from uplift.common.files import write_text
from uplift.lab.chart.draw_panel import draw_panel, label_panel
from uplift.lab.chart.legend import draw_legend, draw_shapes
from uplift.lab.chart.panels import Panel, all_panels, panels_of
from uplift.lab.chart.table import Chart
from uplift.viz.figure import STYLE, to_page_svg, to_svg, write_png
from uplift.viz.scatter import new_panels, style_title

SHOWN = 3
"""Panels of each number of colours per call in the figure; pages show all."""
PANEL_SIZE = (5.6, 4.0)
"""Inches of each."""
MARGINS = {"left": 0.045, "right": 0.99, "bottom": 0.03, "top": 0.975, "wspace": 0.13, "hspace": 0.28}
PAGE_PANEL_SIZE = (4.1, 3.0)
"""Inches of a panel of a page, where it is about as wide on a desk as on a phone."""
PAGE_MARGINS = {"left": 0.115, "right": 0.955, "bottom": 0.165, "top": 0.99}
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


def write_panel(chart: Chart, panel: Panel, png: Path, *, force: bool = False) -> None:
    """Write one panel as PNG, as wide as a phone.

    Parameters
    ----------
    chart : Chart
        The chart.
    panel : Panel
        The panel.
    png : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _one_panel(panel, chart, 0, PAGE_MARGINS | {"top": 0.92})
        style_title(axes, panel.colours)
        write_png(figure, png, force=force)


def page_panels(chart: Chart) -> list[tuple[Panel, Markup]]:
    """Draw the panels of a chart one by one for a page.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    list of tuple
        Every panel with its ``svg`` element.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        panels = enumerate(all_panels(chart))
        return [(panel, _page_panel(panel, chart, number)) for number, panel in panels]


def page_key(chart: Chart) -> Markup:
    """Draw the legend of shapes and lines of a page.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    Markup
        An ``svg`` element.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, cells = new_panels(1, 1, KEY_SIZE, {"left": 0, "right": 1, "bottom": 0, "top": 1})
        figure.patch.set_visible(False)
        cells[0, 0].set_axis_off()
        draw_shapes(cells[0, 0], chart, (0.0, 1.0))
        return to_page_svg(figure, "Meanings of shapes and lines")


def draw(chart: Chart) -> Any:
    """Return the matplotlib figure; its artists are named ``marker-<panel>-<row>``, ``whisker-…`` and ``label-…``."""
    rows = [panels_of(batch)[:SHOWN] for batch in chart.batches]
    figure, cells = new_panels(len(rows) + 1, SHOWN, PANEL_SIZE, MARGINS)
    drawn = [(axes, panel) for row, panels in enumerate(rows) for axes, panel in zip(cells[row], panels, strict=True)]
    for number, (axes, panel) in enumerate(drawn):
        draw_panel(axes, panel, chart, number)
        style_title(axes, f"{_title(panel)}\n{panel.colours}")
    for axes in cells[-1]:
        axes.set_axis_off()
    draw_legend(cells[-1, 0], chart)
    for number, (axes, panel) in enumerate(drawn):
        label_panel(axes, panel, chart, number)
    return figure


def _title(panel: Panel) -> str:
    return f"{panel.title}, {panel.unit}"


def _one_panel(panel: Panel, chart: Chart, number: int, margins: dict[str, float]) -> tuple[Any, Any]:
    figure, cells = new_panels(1, 1, PAGE_PANEL_SIZE, margins)
    draw_panel(cells[0, 0], panel, chart, number)
    label_panel(cells[0, 0], panel, chart, number)
    return figure, cells[0, 0]


def _page_panel(panel: Panel, chart: Chart, number: int) -> Markup:
    figure, axes = _one_panel(panel, chart, number, PAGE_MARGINS)
    for background in (figure.patch, axes.patch):
        background.set_visible(False)
    return to_page_svg(figure, f"{_title(panel)}, {panel.colours}, over {panel.axis}")
