"""Figures of a comparison, and its page: box plots as in Kment 2011, figures 6.1 and 6.2, and error over cost."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.lab.comparison.compare import HEADINGS, Comparison, RepresentationResult
from uplift.lab.comparison.filters import TunedFilter
from uplift.viz.figure import GREY, INK, OTHER, STYLE, new_figure, style_axes, to_page_svg, write_png
from uplift.viz.format import capitalise, format_error, format_time
from uplift.viz.html import Tooltip
from uplift.viz.scatter import (
    FRONT_LINE,
    LEGEND,
    MARKER,
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

COLOURS = {
    "point sampling": "#1f6fb4",
    "point sampling, filtered": "#35a7d8",
    "Riemann sums": "#d98200",
    "enhanced Riemann sums": "#8c4a00",
    "Sun's composite": "#c8323f",
    "Gaussian quadrature": "#12897b",
    "trigonometric moments": "#7b4fa3",
    "sigmoid": "#d05fa2",
    "linear model (PCA)": "#5a5a5a",
    "hero wavelengths": "#5b8c1f",
}


def family_colour(family: str) -> str:
    """``#rrggbb`` of a family."""
    return COLOURS.get(family, OTHER)


def family_colours(families: Iterable[str]) -> dict[str, str]:
    """Colours of the given families in the order of `COLOURS`, unknown families last."""
    present = set(families)
    names = [*(family for family in COLOURS if family in present), *sorted(present - COLOURS.keys())]
    return {name: family_colour(name) for name in names}


PANEL_SIZE, LEGEND_HEIGHT = (6.0, 4.0), 0.55
"""Inches."""
PAGE_MARGINS = {"left": 0.1, "right": 0.97, "bottom": 0.14, "top": 0.99}
FAMILY_LINE = {"linewidth": 0.8, "alpha": 0.45, "zorder": 1}
"""Style of the lines from each size of a family to the next."""
MIN_ERROR = 1e-3
"""Smaller ΔE00 are not visible and are drawn here."""


@dataclass(frozen=True)
class Cost:
    """A kind of cost.

    ``title``: label of the axis.
    ``short``: one word for titles.
    ``of``: the cost of a result.
    ``format``: text of a value.
    ``ticks``: ticks of the axis, by default powers of ten.
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


def draw_cost(comparison: Comparison) -> Any:
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
    """Draw the panels one by one for a page."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return [(f"{panel.title}, over {panel.cost.short}", _page_panel(panel)) for panel in _panels(comparison)]


def _page_panel(panel: _Panel) -> Markup:
    figure, cells = new_panels(1, 1, PAGE_PANEL_SIZE, PAGE_MARGINS)
    _draw_panel(cells[0, 0], panel)
    _draw_labels(cells[0, 0], panel)
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
    """Number the representations, independent of the set of lights."""
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
    colours = family_colours(result.family for result in comparison.results)
    styles = {name: {"color": colour} for name, colour in colours.items()} | {"Pareto front": FRONT_LINE}
    figure.legend(legend_handles(styles.values()), list(styles), loc="lower center", ncols=6, **LEGEND)


WIDTH, PANEL_HEIGHT = 13.2, 4.0
"""Inches."""
NARROW_WIDTH, ROW_HEIGHT = 4.1, 0.155
"""Inches of a figure for phones, and of each of its boxes."""
LABEL = "Box plots of the errors of all representations"
"""Text for screen readers."""
VISIBLE = 1.0
"""ΔE00 that is just visible side by side; the thesis prints smaller ones in bold."""


def draw_boxes(comparison: Comparison, *, upright: bool = True) -> Any:
    """Return the matplotlib figure, of upright boxes for a desk or of lying ones for a phone."""
    counts = [len(comparison.of(name)) for name in comparison.sets]
    if upright:
        figure, heights = new_figure(WIDTH, PANEL_HEIGHT * len(counts)), None
    else:
        figure, heights = new_figure(NARROW_WIDTH, ROW_HEIGHT * sum(counts) + 0.6 * len(counts)), counts
    panels = figure.subplots(len(counts), 1, squeeze=False, height_ratios=heights)[:, 0]
    for axes, (name, title) in zip(panels, comparison.sets.items(), strict=True):
        _draw_box_panel(axes, capitalise(title), comparison.of(name), upright=upright)
    return figure


def page_figures(comparison: Comparison) -> tuple[Markup, Markup]:
    """Draw the boxes for a page, upright on a desk and lying on a phone."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        upright, lying = draw_boxes(comparison), draw_boxes(comparison, upright=False)
        return to_page_svg(upright, LABEL), to_page_svg(lying, LABEL)


def _draw_box_panel(axes: Any, title: str, results: Sequence[RepresentationResult], *, upright: bool) -> None:
    boxes = [_box(result) for result in results]
    orientation = "vertical" if upright else "horizontal"
    artists = axes.bxp(boxes, showfliers=False, patch_artist=True, widths=0.62, orientation=orientation)
    for number, result in enumerate(results):
        colour = family_colour(result.family)
        artists["boxes"][number].set(facecolor=colour, edgecolor="none", alpha=0.85)
        artists["medians"][number].set(color="white", linewidth=1.4)
        for part in (2 * number, 2 * number + 1):
            artists["whiskers"][part].set(color=colour, linewidth=1.0)
            artists["caps"][part].set(color=colour, linewidth=1.0)
    names, values = (axes.xaxis, axes.yaxis) if upright else (axes.yaxis, axes.xaxis)
    lowest = max(MIN_ERROR, 0.7 * min(result.statistics.q2_5 for result in results))
    line = {"color": INK, "linewidth": 0.8, "linestyle": (0, (3, 2)), "zorder": 0}
    if upright:
        axes.axhline(VISIBLE, **line)
        axes.set(yscale="log", ylabel="ΔE00")
        axes.set_ylim(bottom=lowest)
    else:
        axes.axvline(VISIBLE, **line)
        axes.set(xscale="log", xlabel="ΔE00")
        axes.set_xlim(left=lowest)
        axes.invert_yaxis()
    set_log_ticks(values)
    values.set_major_formatter("{x:g}")
    axes.minorticks_off()
    style_title(axes, title)
    style_axes(axes)
    names.grid(visible=False)
    names.set_tick_params(rotation=90 if upright else 0, length=0)
    axes.spines[["left", "bottom"]].set_color(GREY)


def _box(result: RepresentationResult) -> dict[str, Any]:
    """Quartiles, median, and whiskers to the quantiles of 2.5 and 97.5 %."""
    values = result.statistics
    return {
        "label": result.name,
        "med": values.median,
        "q1": values.q25,
        "q3": values.q75,
        "whislo": max(values.q2_5, MIN_ERROR),
        "whishi": values.q97_5,
    }


KINDS = {"boxes": draw_boxes, "cost": draw_cost}
"""Functions that draw a comparison, by kind."""


def write_picture(comparison: Comparison, kind: str, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a figure of a comparison as PNG. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        write_png(KINDS[kind](comparison), path, force=force)


TITLE = "Representations of spectra"
SOURCES = (
    "Kment 2011, Spectral data representation techniques for realistic image synthesis: point sampling, Riemann sums "
    "and their enhancement, the lights and the statistics.",
    "Sun, Drew & Fracchia 1999: the composite model. Peercy 1993: linear models. Wilkie et al. 2014: hero wavelengths. "
    "Peters et al. 2019: trigonometric moments. Jakob & Hanika 2019: the sigmoid.",
)


def render_comparison(comparison: Comparison, tuned: Sequence[TunedFilter] = ()) -> str:
    """Render the page of a comparison."""
    from uplift.viz.html import render

    numbers = numbered(comparison)
    return render(
        "lab/comparison/templates/page.html.j2",
        title=TITLE,
        comparison=comparison,
        pictures=page_panels(comparison),
        boxes=page_figures(comparison),
        families=family_colours(result.family for result in comparison.results),
        tooltips=[_tooltip(name, comparison) for name in numbers],
        facts=comparison.facts,
        sources=SOURCES,
        count=len(numbers),
        statistics=HEADINGS,
        tuned=tuned,
    )


def _tooltip(name: str, comparison: Comparison) -> Tooltip:
    results = [result for result in comparison.results if result.name == name]
    lines = [("floats of a surface", f"{results[0].floats:.1f}")]
    for result in results:
        errors = f"{format_error(result.statistics.mean)} / {format_error(result.statistics.q97_5)}"
        lines += [
            (f"{result.lights}: ΔE00, mean / 97.5 %", errors),
            (f"{result.lights}: floats of a light", f"{result.light_floats:.1f}"),
            (f"{result.lights}: product", format_time(result.ns.median)),
        ]
    return {"title": name, "family": results[0].family, "lines": lines}
