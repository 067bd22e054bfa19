"""Chart of a decision's candidates."""

from __future__ import annotations

from typing import Any

from uplift.scene.plan.decision import Decision
from uplift.viz.figure import ACCENT, GREY, INK, PALE, STYLE, figure_text, new_figure, to_page_svg
from uplift.viz.html import Markup

SIZE = 4.6, 2.6
"""Inches."""
MIN_ERROR = 1e-3
"""Smaller errors are drawn at this ΔE00."""


def trials_chart(decision: Decision) -> Markup:
    """SVG of ΔE00 over cost with the limit as a dashed line and the selected candidate filled."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = new_figure(*SIZE)
        axes = figure.subplots()
        for background in (figure.patch, axes.patch):
            background.set_visible(False)
        costs = [trial.cost for trial in decision.trials]
        errors = [max(trial.error.quantile, MIN_ERROR) for trial in decision.trials]
        selected = decision.selected
        axes.set(xscale="log", yscale="log", xlabel=decision.unit, ylabel="ΔE00")
        axes.axhline(decision.limit, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        axes.plot(costs, errors, "o", markersize=6, markerfacecolor="white", markeredgecolor=ACCENT)
        axes.plot(costs[selected], errors[selected], "o", markersize=8, color=ACCENT)
        for index, (trial, *point) in enumerate(zip(decision.trials, costs, errors, strict=True)):
            _annotate(axes, trial.name, point, above=bool(index % 2), selected=index == selected)
        _style_log_axes(axes)
        return to_page_svg(figure, f"ΔE00 over {decision.unit} of the candidates")


def _annotate(axes: Any, name: str, point: list[float], *, above: bool, selected: bool) -> None:
    axes.annotate(
        figure_text(name),
        point,
        xytext=(5, 5 if above or selected else -11),
        textcoords="offset points",
        fontsize=7.5,
        fontweight="bold" if selected else "normal",
        color=ACCENT if selected else GREY,
    )


def _style_log_axes(axes: Any) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.margins(0.16, 0.14)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.12g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.minorticks_off()
    axes.grid(color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
