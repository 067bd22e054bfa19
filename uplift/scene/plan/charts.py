"""Chart of a decision's candidates."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.plan.decision import Decision
from uplift.viz.figure import ACCENT, GREY, INK, STYLE, to_page_svg
from uplift.viz.html import Markup
from uplift.viz.scatter import Label, draw_labels, new_panels, set_log_ticks, style_log_axes

SIZE, MARGINS = (4.1, 2.5), {"left": 0.115, "right": 0.97, "bottom": 0.165, "top": 0.98}
"""Inches, and the position of the axes."""
MIN_ERROR = 1e-3
"""Smaller errors are drawn at this ΔE00."""


def trials_chart(decision: Decision) -> Markup:
    """SVG of ΔE00 over cost with the limit as a dashed line and the selected candidate filled."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, cells = new_panels(1, 1, SIZE, MARGINS)
        axes = cells[0, 0]
        for background in (figure.patch, axes.patch):
            background.set_visible(False)
        points = np.array(
            [(trial.cost, max(trial.error.quantile, MIN_ERROR)) for trial in decision.trials], dtype=float
        )
        selected = points[decision.selected]
        style_log_axes(axes, decision.unit)
        axes.set_ylabel("ΔE00")
        axes.axhline(decision.limit, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        axes.plot(*points.T, "o", markersize=6, markerfacecolor="white", markeredgecolor=ACCENT)
        axes.plot(*selected, "o", markersize=8, color=ACCENT)
        axes.margins(0.12, 0.14)
        for axis in (axes.xaxis, axes.yaxis):
            set_log_ticks(axis)
            axis.set_major_formatter(lambda value, _: f"{value:,.12g}")
        draw_labels(axes, _labels(decision, points), points, _limit_line(axes, decision.limit))
        return to_page_svg(figure, f"ΔE00 over {decision.unit} of the candidates")


def _labels(decision: Decision, points: Array) -> list[Label]:
    names = [trial.name for trial in decision.trials]
    return [
        Label(name, (x, y), ACCENT if row == decision.selected else GREY, row == decision.selected, "")
        for row, (name, (x, y)) in enumerate(zip(names, points.tolist(), strict=True))
    ]


def _limit_line(axes: Any, limit: float) -> Array:
    return np.array([(x, limit) for x in axes.get_xlim()])
