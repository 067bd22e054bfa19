"""Box plots of colour differences, as figures 6.1 and 6.2 of the thesis: a panel for each set of lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.lab.comparison.style import colour, heading
from uplift.viz.figure import GREY, INK, PALE, new_figure

WIDTH, PANEL = 13.2, 4.0
"""Inches of the figure, and of each panel's height."""
LEAST = 1e-3
"""ΔE00 below which nothing is drawn."""
SEEN = 1.0
"""ΔE00 that one sees side by side; the thesis prints in bold what stays below."""


def draw(found: Comparison) -> Any:
    """A matplotlib figure."""
    figure = new_figure(WIDTH, PANEL * len(found.sets))
    panels = figure.subplots(len(found.sets), 1, squeeze=False)[:, 0]
    for axes, (name, title) in zip(panels, found.sets.items(), strict=True):
        _draw_panel(axes, heading(title), found.of(name))
    return figure


def _draw_panel(axes: Any, title: str, rows: Sequence[RepresentationResult]) -> None:
    drawn = axes.bxp([_box(row) for row in rows], showfliers=False, patch_artist=True, widths=0.62)
    for number, row in enumerate(rows):
        drawn["boxes"][number].set(facecolor=colour(row.family), edgecolor="none", alpha=0.85)
        drawn["medians"][number].set(color="white", linewidth=1.4)
        for part in (2 * number, 2 * number + 1):
            drawn["whiskers"][part].set(color=colour(row.family), linewidth=1.0)
            drawn["caps"][part].set(color=colour(row.family), linewidth=1.0)
    axes.axhline(SEEN, color=INK, linewidth=0.8, linestyle=(0, (3, 2)), zorder=0)
    axes.set_yscale("log")
    axes.set_ylim(bottom=max(LEAST, 0.7 * min(row.statistics.q2_5 for row in rows)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.minorticks_off()
    axes.set_ylabel("ΔE00")
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold", color=INK)
    axes.tick_params(axis="x", rotation=90, length=0)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(GREY)


def _box(row: RepresentationResult) -> dict[str, Any]:
    """The quartiles, the median within, and whiskers to the quantiles of 2.5 and 97.5 %."""
    found = row.statistics
    return {
        "label": row.name,
        "med": found.median,
        "q1": found.q25,
        "q3": found.q75,
        "whislo": max(found.q2_5, LEAST),
        "whishi": found.q97_5,
    }
