"""A plan as one HTML page that needs nothing else: what to build, and what each candidate would have cost."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from uplift.report.page_parts import note, right, swatch, table
from uplift.scene.plan.charts import budget_chart, trials_chart
from uplift.scene.plan.commands import build_command, expanded_command, texture_command
from uplift.scene.plan.decision import Decision
from uplift.scene.plan.planning import Plan
from uplift.scene.plan.summary import describe_error, describe_metamerism, percent, summary_rows, verdict
from uplift.viz.format import format_error
from uplift.viz.markup import Markup, element, number

OWN = """
.columns { grid-template-columns: repeat(auto-fit, minmax(430px, 1fr)); }
.large .swatch i { width: 52px; height: 34px; } .large td { padding-right: 28px; }
.columns td { white-space: nowrap; }
.word { display: inline-block; max-width: 100%; }
.budget { max-width: 860px; }
"""


def page(plan: Plan, path: Path) -> str:
    """The whole HTML text; ``path`` is that of the plan's file."""
    styles = files("uplift.viz").joinpath("page.css").read_text(encoding="utf-8")
    title = f"A plan for {plan.scene.path.stem}"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", Markup(styles + OWN)),
    )
    body = element(
        "body",
        element("header", element("h1", title), element("p", f"{verdict(plan)}.", class_="lead")),
        _summary(plan),
        _lines(plan, path),
        _sights(plan),
        *(_section(decision) for decision in plan.decisions),
        _judged(plan),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _summary(plan: Plan) -> Markup:
    lines = [
        [row.title, element("b", row.chosen), number(row.error), row.cost, _code(row.cli_args)]
        for row in summary_rows(plan)
    ]
    headings = ["", "the least that will do", right("ΔE00 so far"), "cost", "say"]
    told = note(f"{describe_error(plan)}. {describe_metamerism(plan)}")
    return element(
        "section", table(headings, lines), told, element("div", budget_chart(plan), class_="budget")
    )


def _sights(plan: Plan) -> Markup:
    """Pairs of swatches, a column for each share of the pixels."""
    shares = list(dict.fromkeys(sight.share for sight in plan.previews))
    lights = dict.fromkeys(sight.light for sight in plan.previews)
    by_place = {(sight.light, sight.share): sight for sight in plan.previews}
    lines = [
        [
            light,
            *(element("td", swatch(seen.wanted, seen.planned), format_error(seen.delta_e)) for seen in row),
        ]
        for light, row in ((light, [by_place[light, share] for share in shares]) for light in lights)
    ]
    headings = ["", *(f"{percent(share)} of the pixels are no worse" for share in shares)]
    told = note(
        "Left the best cube at all wavelengths, right the plan; swatches touch, so that a difference shows."
    )
    return element("section", element("h2", "What it looks like"), told, table(headings, lines, "slim large"))


def _lines(plan: Plan, path: Path) -> Markup:
    typed = (build_command(path), expanded_command(plan, path), texture_command(plan, path))
    return element("section", element("h2", "To type"), *(element("p", _code(line)) for line in typed))


def _code(line: str) -> Markup:
    """Words that do not break at their hyphens."""
    words = [element("span", word, class_="word") for word in line.split()]
    return element("code", *(part for word in words for part in (word, " ")))


def _section(decision: Decision) -> Markup:
    lines = [
        [
            element("td", element("b", trial.name) if place == decision.taken else trial.name, class_="name"),
            trial.cost_text,
            number(format_error(trial.error.quantile)),
            number(format_error(trial.error.worst.mean)),
            number(format_error(trial.error.worst.largest)),
            f"{trial.error.worst.group}, {trial.error.worst.light}",
        ]
        for place, trial in enumerate(decision.trials)
    ]
    headings = ["", "cost", right("ΔE00"), right("mean"), right("largest"), "of"]
    told = note(
        f"From the least on, until the chain so far stays within ΔE00 {decision.limit:g}, the dashed line."
    )
    figure = element("div", trials_chart(decision)) if len(lines) > 1 else None
    beside = element("div", figure, table(headings, lines), class_="columns")
    return element("section", element("h2", decision.title), told, beside)


def _judged(plan: Plan) -> Markup:
    parts = zip(plan.predicted.parts, plan.confirmed.parts, strict=True)
    lines = [
        [one.group, one.light]
        + [
            number(format_error(value))
            for part in (one, other)
            for value in (part.mean, part.quantile, part.largest)
        ]
        for one, other in parts
    ]
    kinds = ("mean", percent(plan.scene.quantile), "largest")
    headings = [
        "",
        "light",
        *(right(f"{who}, {kind}") for who in ("predicted", "confirmed") for kind in kinds),
    ]
    told = note(
        "Predicted by the pixels that chose; confirmed by other pixels, asked of the cube that was built."
    )
    return element("section", element("h2", "Predicted, and confirmed"), told, table(headings, lines))
