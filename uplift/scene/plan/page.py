"""Plan as a self-contained HTML page: the summary, the commands, and every candidate."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from uplift.scene.plan.charts import trials_chart
from uplift.scene.plan.commands import build_command, expanded_command, texture_command
from uplift.scene.plan.planning import Plan
from uplift.scene.plan.previews import Preview
from uplift.scene.plan.summary import describe_error, describe_metamerism, percent, summary_rows, verdict
from uplift.viz.format import format_error
from uplift.viz.html import render

TEMPLATE = "scene/plan/templates/page.html.j2"
AXIS_MARGIN = 1.08
"""Range of the bars, against the largest value."""


def page(plan: Plan, path: Path) -> str:
    """HTML of a plan; ``path`` is that of the plan file, which the commands refer to."""
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
        previews=_previews_by_light(plan),
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


def _previews_by_light(plan: Plan) -> list[tuple[str, list[Preview]]]:
    lights = dict.fromkeys(preview.light for preview in plan.previews)
    return [(light, [each for each in plan.previews if each.light == light]) for light in lights]
