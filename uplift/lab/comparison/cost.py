"""The chart of error over cost: a row of panels for each set of lights, a column for each kind of cost."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.lab.comparison.families import family_colour, family_colours
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.viz.figure import STYLE, to_page_svg
from uplift.viz.format import capitalise, format_time
from uplift.viz.scatter import (
    FRONT_LINE,
    LEGEND,
    MARKER,
    Label,
    draw_labels,
    new_panels,
    pareto_front,
    pareto_steps,
    set_log_ticks,
    style_log_axes,
    style_title,
)

PANEL_SIZE, LEGEND_HEIGHT = (6.0, 4.0), 0.55
"""Inches."""
PAGE_PANEL_SIZE = (4.1, 3.0)
"""Inches of a panel of a page, where it is about as wide on a desk as on a phone."""
PAGE_MARGINS = {"left": 0.1, "right": 0.97, "bottom": 0.14, "top": 0.99}
FAMILY_LINE = {"linewidth": 0.8, "alpha": 0.45, "zorder": 1}
"""Style of the lines from each size of a family to the next."""
MIN_ERROR = 1e-3
"""Smaller ΔE00 are not visible and are drawn here."""


@dataclass(frozen=True)
class Cost:
    """A kind of cost.

    Parameters
    ----------
    title : str
        Label of the axis.
    short : str
        One word for titles.
    of : callable
        The cost of a result.
    format : callable
        Text of a value.
    ticks : tuple of float
        Ticks of the axis, by default powers of ten.
    """

    title: str
    short: str
    of: Callable[[RepresentationResult], float]
    format: Callable[[float], str]
    ticks: tuple[float, ...] = ()


COSTS = (
    Cost("CPU time of a product", "time", lambda result: result.ns.median, format_time),
    Cost(
        "floats stored of a surface",
        "memory",
        lambda result: result.floats,
        "{:g}".format,
        (4, 8, 16, 32, 64, 128, 256),
    ),
)


def draw(comparison: Comparison) -> Any:
    """Return the matplotlib figure. Artists have the identifiers ``marker-<panel>-<number>``, ``label-…``, with the
    numbers of `numbered`."""
    height = PANEL_SIZE[1] * len(comparison.sets) + LEGEND_HEIGHT
    margins = {
        "left": 0.06,
        "right": 0.985,
        "bottom": (LEGEND_HEIGHT + 0.6) / height,
        "top": 1 - 0.35 / height,
        "wspace": 0.13,
        "hspace": 0.27,
    }
    figure, cells = new_panels(len(comparison.sets), len(COSTS), PANEL_SIZE, margins, LEGEND_HEIGHT)
    panels = list(zip(cells.ravel(), _panels(comparison), strict=True))
    for axes, panel in panels:
        _draw_panel(axes, panel)
        style_title(axes, panel.title)
    _draw_legend(figure, comparison)
    for axes, panel in panels:
        _draw_labels(axes, panel)
    return figure


def page_panels(comparison: Comparison) -> list[tuple[str, Markup]]:
    """Draw the panels one by one for a page.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    list of tuple
        Title and ``svg`` element of every panel.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return [(f"{panel.title}, over {panel.cost.short}", _page_panel(panel)) for panel in _panels(comparison)]


def _page_panel(panel: _Panel) -> Markup:
    figure, cells = new_panels(1, 1, PAGE_PANEL_SIZE, PAGE_MARGINS)
    axes = cells[0, 0]
    for background in (figure.patch, axes.patch):
        background.set_visible(False)
    _draw_panel(axes, panel)
    _draw_labels(axes, panel)
    return to_page_svg(figure, f"{panel.title}, over {panel.cost.title}")


@dataclass(frozen=True)
class _Panel:
    """Results under one set of lights over one cost; ``gids`` are the ends of identifiers by name."""

    title: str
    cost: Cost
    results: Sequence[RepresentationResult]
    gids: dict[str, str]


def _panels(comparison: Comparison) -> list[_Panel]:
    kinds = [(name, title, cost) for name, title in comparison.sets.items() for cost in COSTS]
    numbers = numbered(comparison).items()
    return [
        _Panel(
            f"{capitalise(title)}, ΔE00 of 97.5 %",
            cost,
            comparison.of(name),
            {each: f"{panel}-{number}" for each, number in numbers},
        )
        for panel, (name, title, cost) in enumerate(kinds)
    ]


def numbered(comparison: Comparison) -> dict[str, int]:
    """Number the representations, independent of the set of lights.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    dict of str to int
        Numbers from 0 by name.
    """
    names = dict.fromkeys(result.name for result in comparison.results)
    return {name: number for number, name in enumerate(names)}


def front(results: Sequence[RepresentationResult], cost: Cost) -> list[RepresentationResult]:
    """Return the Pareto front, cheapest first."""
    return [results[row] for row in pareto_front(np.array([_point(result, cost) for result in results]))]


def _point(result: RepresentationResult, cost: Cost) -> tuple[float, float]:
    return max(cost.of(result), 1.0), max(result.statistics.q97_5, MIN_ERROR)


def _draw_panel(axes: Any, panel: _Panel) -> None:
    cost, results, gids = panel.cost, panel.results, panel.gids
    style_log_axes(axes, cost.title)
    for family, colour in family_colours(result.family for result in results).items():
        members = sorted((each for each in results if each.family == family), key=lambda each: each.floats)
        for pair in pairwise(members):
            ends = np.array([_point(result, cost) for result in pair])
            axes.plot(*ends.T, gid=f"whisker-{gids[pair[1].name]}", **FAMILY_LINE, color=colour)
    on_front = front(results, cost)
    for result in results:
        best = result in on_front
        style = MARKER | {"color": family_colour(result.family), "markersize": 7.0 if best else 5.5}
        axes.plot(*_point(result, cost), gid=f"marker-{gids[result.name]}", zorder=3 if best else 2, **style)
    axes.margins(0.07)
    if cost.ticks:
        axes.set_xticks(cost.ticks)
    else:
        set_log_ticks(axes.xaxis)
    set_log_ticks(axes.yaxis)
    axes.xaxis.set_major_formatter(lambda value, _: cost.format(value))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.plot(*_front_line(axes, cost, results).T, scalex=False, zorder=1, **FRONT_LINE)


def _front_line(axes: Any, cost: Cost, results: Sequence[RepresentationResult]) -> Array:
    points = np.array([_point(result, cost) for result in front(results, cost)])
    return pareto_steps(points, axes.get_xlim()[1])


def _draw_labels(axes: Any, panel: _Panel) -> None:
    cost, results = panel.cost, panel.results
    on_front = front(results, cost)
    labels = [
        Label(
            result.name,
            _point(result, cost),
            family_colour(result.family),
            result in on_front,
            f"label-{panel.gids[result.name]}",
        )
        for result in results
    ]
    draw_labels(axes, labels, np.array([label.point for label in labels]), _front_line(axes, cost, results))


def _draw_legend(figure: Any, comparison: Comparison) -> None:
    from matplotlib.lines import Line2D

    colours = family_colours(result.family for result in comparison.results)
    styles = {name: MARKER | {"color": colour} for name, colour in colours.items()}
    styles["Pareto front"] = MARKER | FRONT_LINE
    handles = [Line2D([], [], **style) for style in styles.values()]
    figure.legend(handles, list(styles), loc="lower center", ncols=6, **LEGEND)
