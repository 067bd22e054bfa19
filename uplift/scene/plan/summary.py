"""Summary of a plan as text, for terminal and page."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.scene.plan.decision import Decision
from uplift.scene.plan.evaluation import ErrorSummary
from uplift.scene.plan.final_build import FinalBuild
from uplift.scene.plan.planning import Plan
from uplift.viz.format import format_error, format_size


@dataclass(frozen=True)
class SummaryRow:
    """One line of the summary: heading, selected candidate, cost, command-line options, and ΔE00 of the chain."""

    title: str
    chosen: str
    cost: str
    cli_args: str
    error: str


def summary_rows(plan: Plan) -> list[SummaryRow]:
    """Rows in the order of the decisions; the one about cells follows the lattice."""
    rows = [_decision_row(decision) for decision in plan.decisions]
    place = 1 + next(number for number, each in enumerate(plan.decisions) if each.key == "lattice")
    return [*rows[:place], _cells_row(plan.final_build, rows[place - 1].error), *rows[place:]]


def _decision_row(decision: Decision) -> SummaryRow:
    trial = decision.trial
    error = format_error(trial.error.quantile)
    return SummaryRow(decision.title, trial.name, trial.cost_text, trial.cli_args, error)


def _cells_row(build: FinalBuild, error: str) -> SummaryRow:
    cost = f"{build.points:,} points, {format_size(build.size)}, {build.seconds:.1f} s"
    if build.is_sparse:
        cost += f"; all cells: {format_size(build.full_size)}"
        return SummaryRow("Cells", "those of the textures", cost, "--scene IMAGE", error)
    cost += f"; those of the textures alone: {format_size(build.sparse_size)}, too small a saving"
    return SummaryRow("Cells", "all", cost, "", error)


def verdict(plan: Plan) -> str:
    """Errors and tolerance in one phrase."""
    end = "" if plan.within_tolerance else "; the tolerance is EXCEEDED: plan for a smaller one"
    return (
        f"ΔE00 {format_error(plan.predicted.quantile)} predicted, {format_error(plan.confirmed.quantile)} confirmed on "
        f"other pixels, tolerance {plan.scene.tolerance:g}{end}"
    )


def describe_error(plan: Plan) -> str:
    """Definition of the errors."""
    scene = plan.scene
    materials = " and of the atlas's entries" if scene.atlases else ""
    measured = ", entries with their measurements" if scene.atlases else ""
    return (
        f"ΔE00 of {percent(scene.quantile)} of the textures' pixels{materials} is at most this value, under the worst "
        f"of {', '.join(scene.lights)}. Pixels are compared with a cube of the finest lattice and the most "
        f"coefficients at all wavelengths{measured}"
    )


def describe_metamerism(plan: Plan) -> str:
    """Expected difference between measurements and any answer; empty if it is not known."""
    if plan.expected_error is None:
        return ""
    return (
        "RGB alone does not identify a material: measurements of such colours are expected to differ by ΔE00 "
        f"{format_error(plan.expected_error)} under A from any answer"
    )


def percent(share: float) -> str:
    """A share in percent.

    >>> percent(0.975)
    '97.5 %'
    """
    return f"{100 * share:.4g} %"


def worst_case(error: ErrorSummary) -> str:
    """Group and light of the worst part, as in "textures under FL11"."""
    return f"{error.worst.group} under {error.worst.light}"
