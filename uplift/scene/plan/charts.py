"""Charts of a plan's page: how candidates come down to what is tolerated, and what each decision takes of it."""

from __future__ import annotations

from typing import Any

from uplift.scene.plan.decision import Decision
from uplift.scene.plan.planning import Plan
from uplift.viz.figure import ACCENT, GREY, INK, PALE, STYLE, new_figure, to_svg
from uplift.viz.format import format_error
from uplift.viz.markup import Markup

SIZE, WIDE = (4.6, 2.6), (9.6, 2.1)
"""Inches."""
LEAST = 1e-3
"""ΔE00 below which errors are drawn alike."""


def trials_chart(decision: Decision) -> Markup:
    """ΔE00 over cost; the dashed line is what the chain so far may be off, the filled marker was taken."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _bare(SIZE)
        trials = decision.trials
        costs = [trial.cost for trial in trials]
        errors = [max(trial.error.quantile, LEAST) for trial in trials]
        axes.set(xscale="log", yscale="log", xlabel=decision.unit, ylabel="ΔE00")
        axes.axhline(decision.limit, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        axes.plot(costs, errors, "o", markersize=6, markerfacecolor="white", markeredgecolor=ACCENT)
        axes.plot(costs[decision.taken], errors[decision.taken], "o", markersize=8, color=ACCENT)
        for place, (trial, cost, error) in enumerate(zip(trials, costs, errors, strict=True)):
            taken = place == decision.taken
            axes.annotate(
                trial.name,
                (cost, error),
                xytext=(5, 5 if place % 2 or taken else -11),
                textcoords="offset points",
                fontsize=7.5,
                fontweight="bold" if taken else "normal",
                color=ACCENT if taken else GREY,
            )
        _finish(axes)
        return to_svg(figure)


def _bare(size: tuple[float, float]) -> tuple[Any, Any]:
    """The page shows through."""
    figure = new_figure(*size)
    axes = figure.subplots()
    figure.patch.set_visible(False)
    axes.patch.set_visible(False)
    return figure, axes


def _finish(axes: Any) -> None:
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


def budget_chart(plan: Plan) -> Markup:
    """A bar for the error after each decision, the mark that it was to stay within, and the tolerance."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _bare(WIDE)
        named = [(each.title, each.trial.error.quantile, each.limit) for each in plan.chain]
        named.append(("Confirmed", plan.confirmed.quantile, plan.scene.tolerance))
        for row, (_, error, limit) in enumerate(named):
            axes.barh(row, error, height=0.55, color=INK if row == len(named) - 1 else ACCENT)
            axes.plot([limit, limit], [row - 0.4, row + 0.4], color=INK, linewidth=1)
            axes.annotate(
                format_error(error), (error, row), xytext=(4, 0), textcoords="offset points", va="center"
            )
        axes.set(
            yticks=range(len(named)),
            yticklabels=[title for title, _, _ in named],
            xlabel="ΔE00 so far; the marks are what may be used up",
        )
        axes.set_xlim(0, 1.08 * max(plan.scene.tolerance, *(error for _, error, _ in named)))
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.spines[["top", "right", "left"]].set_visible(False)
        return to_svg(figure)
