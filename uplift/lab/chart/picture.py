"""The chart as a figure, a row of panels for each number of colours per call, and as a page with tooltips.

Of the cubes of this package a panel shows those that no other cube of the same kind and mode beats."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.arrays import Array
from uplift.common.files import write_text
from uplift.lab.chart.measure import REFERENCE
from uplift.lab.chart.methods import FAMILIES
from uplift.lab.chart.table import (
    BATCH,
    CLEAR_RATIO,
    MIN_ERROR,
    Chart,
    MethodResult,
    Panel,
    State,
    all_panels,
    panels_of,
)
from uplift.viz.figure import GREY, OTHER, STYLE, figure_text, to_page_svg, to_svg, write_png
from uplift.viz.format import format_build_time, format_error, format_size, format_time
from uplift.viz.html import Tooltip
from uplift.viz.scatter import (
    FRONT_LINE,
    LEGEND,
    PAGE_PANEL_SIZE,
    Label,
    draw_labels,
    legend_handles,
    new_panels,
    pareto_front,
    pareto_steps,
    set_log_ticks,
    style_log_axes,
    style_title,
)

SHAPES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P"}
"""Markers of cubes of this package, by mode of lookup."""
OTHER_SHAPE = "*"
"""Marker of all other methods."""
WIDTHS = {OTHER_SHAPE: 9.5, "o": 6.5, "^": 6.5, "s": 6.0, "D": 5.5, "P": 7.0}
"""Widths of markers in points."""
BAR: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 5, "solid_capstyle": "butt"}
"""Style of a colour in the legend, which no marker has."""
SINGLE: dict[str, Any] = {"markerfacecolor": "white", "markeredgewidth": 1.2}
"""Style of methods that are too slow for the number of colours, and were timed with fewer per call."""
WHISKER: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 1.6}


def family_colours(families: Iterable[str]) -> dict[str, str]:
    """``#rrggbb`` of the given families, each once; `OTHER` for families of other versions."""
    known = {family.name: family.colour for family in FAMILIES}
    return {name: known.get(name, OTHER) for name in families}


def marker_style(mode: str) -> dict[str, Any]:
    """Shape and size of the marker of a mode; the empty mode is that of other methods."""
    shape = SHAPES.get(mode, OTHER_SHAPE)
    return {"marker": shape, "markersize": WIDTHS[shape]}


def draw_legend(axes: Any, chart: Chart) -> None:
    """Fill a cell without axes: colours, and the meanings of shapes and lines."""
    families = family_colours(result.family for result in chart.measured)
    colours = [(name, BAR | {"color": colour}) for name, colour in families.items()]
    _draw_key(axes, (0.0, 1.0), "method", colours)
    draw_shapes(axes, chart, (0.46, 1.0))


def draw_shapes(axes: Any, chart: Chart, corner: tuple[float, float]) -> None:
    """Draw the meanings of shapes and lines with the upper left corner at a position of the cell."""
    modes = [mode for mode in SHAPES if any(result.mode == mode for result in chart.measured)]
    single = SINGLE | {"markeredgecolor": GREY}
    entries = [(f"uplift, mode {mode}", marker_style(mode)) for mode in modes]
    entries += [
        ("another method", marker_style("")),
        ("timed with fewer colours per call", marker_style("") | single),
        ("Pareto front", FRONT_LINE),
        ("mean to 99 % to largest", WHISKER),
    ]
    _draw_key(axes, corner, None, entries)


def _draw_key(
    axes: Any, corner: tuple[float, float], title: str | None, entries: Sequence[tuple[str, dict[str, Any]]]
) -> None:
    handles = legend_handles(style for _, style in entries)
    names = [figure_text(name) for name, _ in entries]
    key = axes.legend(handles, names, title=title, loc="upper left", bbox_to_anchor=corner, **LEGEND)
    axes.legend_ = None
    axes.add_artist(key)


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


SHOWN = 3
"""Panels of each number of colours per call in the figure; pages show all."""
PANEL_SIZE = (5.6, 4.0)
"""Inches of each."""
MARGINS = {"left": 0.045, "right": 0.99, "bottom": 0.03, "top": 0.975, "wspace": 0.13, "hspace": 0.28}
PAGE_MARGINS = {"left": 0.115, "right": 0.955, "bottom": 0.165, "top": 0.99}
KEY_SIZE = (4.1, 2.15)
"""Inches of the legend of a page."""

Path = str | os.PathLike[str]


def write_pictures(chart: Chart, png: Path, svg: Path, *, force: bool = False) -> None:
    """Write the figure of a chart as PNG and as SVG. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = draw(chart)
        write_png(figure, png, force=force)
        element = to_svg(figure, "Error over time of all methods, a panel for each error")
    write_text(element, svg, force=force)


def write_panel(chart: Chart, panel: Panel, png: Path, *, force: bool = False) -> None:
    """Write one panel as PNG, as wide as a phone. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _one_panel(panel, chart, 0, PAGE_MARGINS | {"top": 0.92})
        style_title(axes, panel.colours)
        write_png(figure, png, force=force)


def page_panels(chart: Chart) -> list[tuple[Panel, Markup]]:
    """Draw the panels of a chart one by one for a page."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        pages = []
        for number, panel in enumerate(all_panels(chart)):
            figure, _ = _one_panel(panel, chart, number, PAGE_MARGINS)
            label = f"{_title(panel)}, {panel.colours}, over {panel.axis}"
            pages.append((panel, to_page_svg(figure, label)))
        return pages


def page_key(chart: Chart) -> Markup:
    """Draw the legend of shapes and lines of a page."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, cells = new_panels(1, 1, KEY_SIZE, {"left": 0, "right": 1, "bottom": 0, "top": 1})
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


TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip, 1 nm",
    "coarse_round_trip": "round trip, 5 nm",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}
"""Columns of the table: headings by names of errors."""


def render_chart(chart: Chart) -> str:
    """Render the page of a chart."""
    from uplift.viz.html import render

    return render(
        "lab/chart/templates/page.html.j2",
        title=TITLE,
        chart=chart,
        pictures=page_panels(chart),
        key=page_key(chart),
        families=family_colours(result.family for result in chart.measured),
        tooltips=[_tooltip(result) for result in chart.results],
        facts=chart.facts,
        sources=list(dict.fromkeys(f"{result.family}: {result.source}" for result in chart.results)),
        panels=all_panels(chart),
        batches=chart.batches,
        chosen=max((batch for batch in chart.batches if batch <= REFERENCE), default=0),
        errors=ERRORS,
        not_measured=[result for result in chart.results if result.state != State.MEASURED],
    )


def _tooltip(result: MethodResult) -> Tooltip:
    measured = result.state == State.MEASURED
    return {"title": result.title, "family": result.family, "lines": _lines(result) if measured else []}


def _lines(result: MethodResult) -> list[tuple[str, str]]:
    numbers = result.numbers
    lines = []
    for size in sorted(int(match[1]) for name in numbers if (match := BATCH.fullmatch(name))):
        used = int(numbers[f"ns_{size}_colours"])
        fewer = f", timed with {used:,}" if used < size else ""
        lines.append((f"{size:,} per call{fewer}", f"{format_time(numbers[f'ns_{size}'])} each"))
    lines.append(("memory", format_size(numbers["bytes"])))
    for name in ("build", "load"):
        if f"{name}_s" in numbers:
            lines.append((name, format_build_time(numbers[f"{name}_s"])))
    lines.append(("errors", "mean / 99 % / largest"))
    lines += [
        (name, " / ".join(format_error(numbers[f"{error}_{kind}"]) for kind in ("mean", "p99", "max")))
        for error, name in ERRORS.items()
    ]
    count = f"{numbers['round_trip_colours']:g} colours, {numbers['unseen_spectra']:g} materials"
    lines.append(("test set", count))
    return lines + [("", text) for text in (result.build, result.ask, result.note) if text]
