"""Speed and accuracy of all methods, for docs/speed.md and its pictures, and for
``uplift chart --recommend``.
"""

from itertools import chain

from benchmarks import DOCS, ROOT, Row, show
from benchmarks.choices import POOLED, mark
from benchmarks.materials import read_atlases
from uplift.common.files import write_text
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.lab.chart.measure import measure_methods
from uplift.lab.chart.picture import render_chart, write_picture
from uplift.lab.chart.results import (
    MEASURED,
    Chart,
    MethodResult,
    State,
    chart_csv,
    criteria,
)
from uplift.lab.chart.selection import select_methods
from uplift.lab.chart.task import make_task
from uplift.lab.study.held_out import HALF, LOCAL_LINEAR, METAMER_MEAN, NO_ATLAS

RIVALS = {"local-linear": LOCAL_LINEAR, "metamer-mean": METAMER_MEAN}
"""Methods without a cube whose choices were made with measured materials."""
UNSEEN = ("lights", "rms")
"""Errors of panels that are those of unseen materials."""


def chart() -> Row:
    """Measure, draw and store."""
    return publish(measure_methods(select_methods(), make_task(read_atlases()), show))


def publish(chart: Chart) -> Row:
    """Write the table that the package carries and the pictures; return the data of
    the page.

    ``publish(shipped_chart())`` does so without measuring again.
    """
    folder = DOCS / "chart"
    table = ROOT / "uplift" / "lab" / "chart" / MEASURED
    write_text(chart_csv(chart), table, force=True)
    write_picture(chart, folder / "chart.png", force=True)
    write_text(render_chart(chart), folder / "chart.html", force=True)
    return {
        "facts": dict(chart.facts),
        "batches": chart.batches,
        "lights": CHART_LIGHTS,
        "fronts": fronts(chart),
        "methods": [method_record(row, chart.batches) for row in chart.measured],
        "excluded": [
            {"method": row.title, "state": row.state, "reason": row.why}
            for row in chart.results
            if row.state != State.MEASURED
        ],
    }


def fronts(chart: Chart) -> list[Row]:
    """Return the Pareto front of every panel, fastest first. Times are in ns."""
    rows = []
    for criterion in chain.from_iterable(map(criteria, chart.batches)):
        for row in criterion.front(chart):
            rows.append(
                {
                    "panel": criterion.title,
                    "colours": criterion.batch,
                    "method": row.title,
                    "time": criterion.time(row),
                    "error": row.numbers[f"{criterion.error}_mean"],
                    "mark": optimistic_mark(row) if criterion.error in UNSEEN else "",
                }
            )
    return rows


def method_record(row: MethodResult, batches: tuple[int, ...]) -> Row:
    """Return the figures of a method; ``mark_N`` marks calls with fewer than N colours,
    ``total_N`` has the set-up.
    """
    numbers = row.numbers
    figures = {
        "name": row.method,
        "method": row.title,
        "mark": optimistic_mark(row),
        "dtype": row.dtype,
        "note": row.note,
        "build_s": None,
        **numbers,
    }
    spreads = []
    for batch in batches:
        name = f"ns_{batch}"
        figures[f"mark_{batch}"] = "≈ " if numbers[f"{name}_colours"] < batch else ""
        figures[f"total_{batch}"] = 1e9 * numbers["setup_s"] + batch * numbers[name]
        spreads.append(numbers[f"{name}_most"] / numbers[f"{name}_least"] - 1)
    return {**figures, "spread": max(spreads)}


def optimistic_mark(row: MethodResult) -> str:
    """Return the mark of the errors of unseen materials, which are of all shipped sets.

    The choices are those of cubes of moments; the colour alone determines a sigmoid.
    """
    if row.method in RIVALS:
        return mark(POOLED, RIVALS[row.method])
    if not row.build or "--model" in row.build:
        return ""
    return mark(POOLED, HALF if "--atlas" in row.build else NO_ATLAS)


QUESTIONS = {"chart": chart}
