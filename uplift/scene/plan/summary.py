"""A plan in few words, for the terminal and the page."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.scene.plan.decision import Decision
from uplift.scene.plan.evaluation import Error
from uplift.scene.plan.final_build import Built
from uplift.scene.plan.planning import Plan
from uplift.viz.format import format_error, format_size


@dataclass(frozen=True)
class Row:
    """One line of the plan: what is decided, for what, at which cost, how to say it, and the ΔE00 so far."""

    title: str
    chosen: str
    cost: str
    typed: str
    error: str


def rows(plan: Plan) -> list[Row]:
    """In the order of the decisions; whole or sparse follows the lattice, which it belongs to."""
    told = [_row(decision) for decision in plan.decisions]
    place = 1 + next(number for number, each in enumerate(plan.decisions) if each.key == "lattice")
    return [*told[:place], _cells(plan.built, told[place - 1].error), *told[place:]]


def _row(decision: Decision) -> Row:
    trial = decision.trial
    return Row(decision.title, trial.name, trial.told, trial.typed, format_error(trial.error.quantile))


def _cells(made: Built, error: str) -> Row:
    cost = f"{made.points:,} points, {format_size(made.size)}, {made.seconds:.1f} s"
    if made.is_sparse:
        told = f"{cost}; all: {format_size(made.whole)}"
        return Row("Cells", "the textures' own", told, "--scene IMAGE", error)
    told = (
        f"{cost}; the textures' own: {format_size(made.sparse)}, too little saved to answer no other colours"
    )
    return Row("Cells", "all", told, "", error)


def verdict(plan: Plan) -> str:
    """The plan in a sentence."""
    brief = plan.brief
    end = "" if plan.within else ", which is MORE than is tolerated: plan for a smaller tolerance"
    return (
        f"ΔE00 {format_error(plan.predicted.quantile)} predicted, {format_error(plan.confirmed.quantile)} confirmed by "
        f"other pixels, {brief.tolerance:g} tolerated{end}"
    )


def about(plan: Plan) -> str:
    """What the errors are."""
    brief = plan.brief
    own, measured = " and of the atlas's materials", ", materials against their measurements"
    return (
        f"ΔE00 that {percent(brief.quantile)} of the textures' pixels{own if brief.atlases else ''} stay within, under "
        f"the worst of {', '.join(brief.lights)}; pixels against a cube of the finest lattice and the most "
        f"coefficients at all wavelengths{measured if brief.atlases else ''}"
    )


def unknown(plan: Plan) -> str:
    """What no plan helps with; empty where nobody knows."""
    if plan.expected is None:
        return ""
    return (
        f"RGB do not tell materials: what has such a colour may differ by ΔE00 {format_error(plan.expected)} under A "
        "from any answer"
    )


def percent(share: float) -> str:
    """97.5 %."""
    return f"{100 * share:.4g} %"


def deciding(error: Error) -> str:
    """textures under FL11."""
    return f"{error.worst.group} under {error.worst.light}"
