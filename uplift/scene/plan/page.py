"""Plan as a self-contained HTML page, and its summary as text for the page and the terminal."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.scene.plan.commands import build_command, expanded_command, texture_command
from uplift.scene.plan.evaluation import Decision
from uplift.scene.plan.planning import FinalBuild, Plan
from uplift.viz.figure import ACCENT, GREY, INK, STYLE, to_page_svg
from uplift.viz.format import format_error, format_size
from uplift.viz.html import Markup, render
from uplift.viz.scatter import Label, draw_labels, new_panels, set_log_ticks, style_log_axes

TEMPLATE = "scene/plan/templates/page.html.j2"
AXIS_MARGIN = 1.08
"""Range of the bars, against the largest value."""
SIZE, MARGINS = (4.1, 2.5), {"left": 0.115, "right": 0.97, "bottom": 0.165, "top": 0.98}
"""Inches of a chart, and the position of its axes."""
MIN_ERROR = 1e-3
"""Smaller errors are drawn at this ΔE00."""


def page(plan: Plan, path: Path) -> str:
    """HTML of a plan; ``path`` is that of the plan file, which the commands refer to."""
    lights = dict.fromkeys(preview.light for preview in plan.previews)
    return render(
        TEMPLATE,
        title=f"Plan for {plan.scene.path.stem}",
        lead=f"{verdict(plan)}.",
        summary=summary_rows(plan),
        definition=describe_error(plan),
        metamerism=describe_metamerism(plan),
        budget=_budget(plan),
        commands=(build_command(path), expanded_command(plan, path), texture_command(plan, path)),
        shares=[percent(share) for share in dict.fromkeys(each.share for each in plan.previews)],
        previews=[(light, [each for each in plan.previews if each.light == light]) for light in lights],
        decisions=[(each, trials_chart(each) if len(each.trials) > 1 else None) for each in plan.decisions],
        quantile=percent(plan.scene.quantile),
        errors=list(zip(plan.predicted.parts, plan.confirmed.parts, strict=True)),
    )


def _budget(plan: Plan) -> list[dict[str, Any]]:
    """Error and limit after each decision and in the end, in percent of the axis."""
    values = [(each.title, each.trial.error.quantile, each.limit) for each in plan.chain]
    values.append(("Confirmed", plan.confirmed.quantile, plan.scene.tolerance))
    scale = 100 / (AXIS_MARGIN * max(max(error, limit) for _, error, limit in values))
    return [
        {"title": title, "error": scale * error, "limit": scale * limit, "text": format_error(error)}
        for title, error, limit in values
    ]


def trials_chart(decision: Decision) -> Markup:
    """SVG of ΔE00 over cost with the limit as a dashed line and the selected candidate filled."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, cells = new_panels(1, 1, SIZE, MARGINS)
        axes = cells[0, 0]
        for background in (figure.patch, axes.patch):
            background.set_visible(False)
        places = [(trial.cost, max(trial.error.quantile, MIN_ERROR)) for trial in decision.trials]
        points = np.array(places, dtype=float)
        style_log_axes(axes, decision.unit)
        axes.set_ylabel("ΔE00")
        axes.axhline(decision.limit, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        axes.plot(*points.T, "o", markersize=6, markerfacecolor="white", markeredgecolor=ACCENT)
        axes.plot(*points[decision.selected], "o", markersize=8, color=ACCENT)
        axes.margins(0.12, 0.14)
        for axis in (axes.xaxis, axes.yaxis):
            set_log_ticks(axis)
            axis.set_major_formatter(lambda value, _: f"{value:,.12g}")
        labels = []
        for row, (trial, (x, y)) in enumerate(zip(decision.trials, points.tolist(), strict=True)):
            is_selected = row == decision.selected
            labels.append(Label(trial.name, (x, y), ACCENT if is_selected else GREY, is_selected, ""))
        draw_labels(axes, labels, points, np.array([(x, decision.limit) for x in axes.get_xlim()]))
        return to_page_svg(figure, f"ΔE00 over {decision.unit} of the candidates")


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
