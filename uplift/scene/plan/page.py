"""Plan as a self-contained HTML page, and its summary as text for the page and the terminal."""

from dataclasses import dataclass
from pathlib import Path

from uplift.scene.plan.plan_file import commands
from uplift.scene.plan.planning import FinalBuild, Plan
from uplift.viz.format import format_error, format_size
from uplift.viz.html import render

TEMPLATE = "scene/plan/templates/page.html.j2"


def page(plan: Plan, path: Path) -> str:
    """HTML of a plan; ``path`` is that of the plan file, which the commands refer to."""
    return render(
        TEMPLATE,
        title=f"Plan for {plan.scene.path.stem}",
        lead=f"{verdict(plan)}.",
        summary=summary_rows(plan),
        definition=describe_error(plan),
        metamerism=describe_metamerism(plan),
        commands=commands(plan, path),
        decisions=plan.decisions,
        quantile=percent(plan.scene.quantile),
        errors=list(zip(plan.predicted.parts, plan.confirmed.parts, strict=True)),
    )


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
    rows = []
    for decision in plan.decisions:
        trial = decision.trial
        error = format_error(trial.error.quantile)
        rows.append(SummaryRow(decision.title, trial.name, trial.cost_text, trial.cli_args, error))
        if decision.key == "lattice":
            rows.append(_cells_row(plan.final_build, error))
    return rows


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
    """A share in percent, such as ``97.5 %``."""
    return f"{100 * share:.4g} %"
