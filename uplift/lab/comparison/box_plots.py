"""Box plots of colour differences as in figures 6.1 and 6.2 of Kment 2011: a panel for each set of lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from markupsafe import Markup

from uplift.lab.comparison.cost import MIN_ERROR
from uplift.lab.comparison.families import family_colour
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.viz.figure import GREY, INK, STYLE, new_figure, style_axes, to_page_svg
from uplift.viz.format import capitalise
from uplift.viz.scatter import set_log_ticks, style_title

WIDTH, PANEL_HEIGHT = 13.2, 4.0
"""Inches."""
NARROW_WIDTH, ROW_HEIGHT = 4.1, 0.155
"""Inches of a figure for phones, and of each of its boxes."""
LABEL = "Box plots of the errors of all representations"
"""Text for screen readers."""
VISIBLE = 1.0
"""ΔE00 that is just visible side by side; the thesis prints smaller ones in bold."""


def draw(comparison: Comparison) -> Any:
    """Return the matplotlib figure."""
    figure = new_figure(WIDTH, PANEL_HEIGHT * len(comparison.sets))
    panels = figure.subplots(len(comparison.sets), 1, squeeze=False)[:, 0]
    for axes, (name, title) in zip(panels, comparison.sets.items(), strict=True):
        _draw_panel(axes, capitalise(title), comparison.of(name))
    return figure


def page_figures(comparison: Comparison) -> tuple[Markup, Markup]:
    """Draw the boxes for a page, upright on a desk and lying on a phone.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    tuple of Markup
        Two ``svg`` elements.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        upright, lying = _transparent(draw(comparison)), _transparent(_draw_narrow(comparison))
        return to_page_svg(upright, LABEL), to_page_svg(lying, LABEL)


def _draw_narrow(comparison: Comparison) -> Any:
    rows = sum(len(comparison.of(name)) for name in comparison.sets)
    figure = new_figure(NARROW_WIDTH, ROW_HEIGHT * rows + 0.6 * len(comparison.sets))
    heights = [len(comparison.of(name)) for name in comparison.sets]
    panels = figure.subplots(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
    for axes, (name, title) in zip(panels, comparison.sets.items(), strict=True):
        _draw_panel(axes, capitalise(title), comparison.of(name), upright=False)
        axes.invert_yaxis()
    return figure


def _transparent(figure: Any) -> Any:
    for background in (figure.patch, *(axes.patch for axes in figure.axes)):
        background.set_visible(False)
    return figure


def _draw_panel(axes: Any, title: str, results: Sequence[RepresentationResult], *, upright: bool = True) -> None:
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
