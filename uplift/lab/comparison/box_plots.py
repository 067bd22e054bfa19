"""Box plots of colour differences as in figures 6.1 and 6.2 of Kment 2011: a panel for each set of lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from uplift.lab.comparison.cost import MIN_ERROR
from uplift.lab.comparison.families import family_colour
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.viz.figure import GREY, INK, new_figure, style_axes
from uplift.viz.format import capitalise
from uplift.viz.scatter import style_title

WIDTH, PANEL_HEIGHT = 13.2, 4.0
"""Inches."""
VISIBLE = 1.0
"""ΔE00 that is just visible side by side; the thesis prints smaller ones in bold."""


def draw(comparison: Comparison) -> Any:
    """Return the matplotlib figure."""
    figure = new_figure(WIDTH, PANEL_HEIGHT * len(comparison.sets))
    panels = figure.subplots(len(comparison.sets), 1, squeeze=False)[:, 0]
    for axes, (name, title) in zip(panels, comparison.sets.items(), strict=True):
        _draw_panel(axes, capitalise(title), comparison.of(name))
    return figure


def _draw_panel(axes: Any, title: str, results: Sequence[RepresentationResult]) -> None:
    boxes = [_box(result) for result in results]
    artists = axes.bxp(boxes, showfliers=False, patch_artist=True, widths=0.62)
    for number, result in enumerate(results):
        colour = family_colour(result.family)
        artists["boxes"][number].set(facecolor=colour, edgecolor="none", alpha=0.85)
        artists["medians"][number].set(color="white", linewidth=1.4)
        for part in (2 * number, 2 * number + 1):
            artists["whiskers"][part].set(color=colour, linewidth=1.0)
            artists["caps"][part].set(color=colour, linewidth=1.0)
    axes.axhline(VISIBLE, color=INK, linewidth=0.8, linestyle=(0, (3, 2)), zorder=0)
    axes.set_yscale("log")
    axes.set_ylim(bottom=max(MIN_ERROR, 0.7 * min(result.statistics.q2_5 for result in results)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.minorticks_off()
    axes.set_ylabel("ΔE00")
    style_title(axes, title)
    style_axes(axes)
    axes.grid(visible=False, axis="x")
    axes.tick_params(axis="x", rotation=90, length=0)
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
