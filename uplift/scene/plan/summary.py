"""A plan in few words, for the terminal and the page."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.scene.plan.decision import Decision
from uplift.scene.plan.evaluation import ErrorSummary
from uplift.scene.plan.final_build import FinalBuild
from uplift.scene.plan.planning import Plan
from uplift.viz.format import format_error, format_size


@dataclass(frozen=True)
class SummaryRow:
    """One line of the plan: what is decided, for what, at which cost, how to say it, and the ΔE00 so far."""

    title: str
    chosen: str
    cost: str
    cli_args: str
    error: str


def summary_rows(plan: Plan) -> list[SummaryRow]:
    """In the order of the decisions; whole or sparse follows the lattice, which it belongs to."""
    told = [_row(decision) for decision in plan.decisions]
    place = 1 + next(number for number, each in enumerate(plan.decisions) if each.key == "lattice")
    return [*told[:place], _cells(plan.final_build, told[place - 1].error), *told[place:]]


def _row(decision: Decision) -> SummaryRow:
    trial = decision.trial
    return SummaryRow(
        decision.title, trial.name, trial.cost_text, trial.cli_args, format_error(trial.error.quantile)
    )


def _cells(made: FinalBuild, error: str) -> SummaryRow:
    cost = f"{made.points:,} points, {format_size(made.size)}, {made.seconds:.1f} s"
    if made.is_sparse:
        told = f"{cost}; all: {format_size(made.whole)}"
        return SummaryRow("Cells", "the textures' own", told, "--scene IMAGE", error)
    told = (
        f"{cost}; the textures' own: {format_size(made.sparse)}, too little saved to answer no other colours"
    )
    return SummaryRow("Cells", "all", told, "", error)


def verdict(plan: Plan) -> str:
    """The plan in a sentence."""
    scene = plan.scene
    end = "" if plan.within_tolerance else ", which is MORE than is tolerated: plan for a smaller tolerance"
    return (
        f"ΔE00 {format_error(plan.predicted.quantile)} predicted, {format_error(plan.confirmed.quantile)} confirmed by "
        f"other pixels, {scene.tolerance:g} tolerated{end}"
    )


def describe_error(plan: Plan) -> str:
    """What the errors are."""
    scene = plan.scene
    own, measured = " and of the atlas's materials", ", materials against their measurements"
    return (
        f"ΔE00 that {percent(scene.quantile)} of the textures' pixels{own if scene.atlases else ''} stay within, under "
        f"the worst of {', '.join(scene.lights)}; pixels against a cube of the finest lattice and the most "
        f"coefficients at all wavelengths{measured if scene.atlases else ''}"
    )


def describe_metamerism(plan: Plan) -> str:
    """What no plan helps with; empty where nobody knows."""
    if plan.expected_error is None:
        return ""
    return (
        f"RGB alone does not identify a material: measurements of such colours may differ by ΔE00 "
        f"{format_error(plan.expected_error)} under A from any answer"
    )


def percent(share: float) -> str:
    """97.5 %."""
    return f"{100 * share:.4g} %"


def worst_case(error: ErrorSummary) -> str:
    """textures under FL11."""
    return f"{error.worst.group} under {error.worst.light}"
