"""Speed and accuracy of all methods, for docs/speed.md and its pictures, and for
``uplift chart --recommend``.
"""

from itertools import chain

from benchmarks import DOCS, Row, show
from benchmarks.materials import read_atlases
from uplift.common.files import write_text
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.lab.chart.measure import measure_methods
from uplift.lab.chart.picture import render_chart, write_picture
from uplift.lab.chart.results import (
    MEASURED,
    Chart,
    chart_csv,
    criteria,
    shipped_chart,
)
from uplift.lab.chart.selection import select_methods
from uplift.lab.chart.task import make_task


def measure() -> None:
    """Measure, draw and store."""
    publish(measure_methods(select_methods(), make_task(read_atlases()), show))


def publish(chart: Chart) -> None:
    """Write the table that the package carries, from which `figures` are, and the
    pictures.
    """
    folder = DOCS / "chart"
    write_text(chart_csv(chart), MEASURED, force=True)
    write_picture(chart, folder / "chart.png", force=True)
    write_text(render_chart(chart), folder / "chart.html", force=True)


def figures() -> Row:
    """Return the figures of the packaged chart for the templates of pages."""
    chart = shipped_chart()
    methods = []
    for row in chart.measured:
        texts = {"name": row.method, "method": row.title, "dtype": row.dtype}
        methods.append({**texts, "note": row.note, **row.numbers})
    return {
        "facts": chart.facts,
        "lights": CHART_LIGHTS,
        "fronts": fronts(chart),
        "methods": methods,
        "is_complete": len(chart.measured) == len(chart.results),
    }


def fronts(chart: Chart) -> list[Row]:
    """Return the Pareto front of every panel, fastest first. Times are in ns."""
    rows = []
    for criterion in chain.from_iterable(map(criteria, chart.batches)):
        for row in criterion.front(chart.measured):
            rows.append(
                {
                    "panel": criterion.title,
                    "colours": criterion.batch,
                    "method": row.title,
                    "time": criterion.time(row),
                    "error": row.numbers[f"{criterion.error}_mean"],
                }
            )
    return rows


QUESTIONS = {"methods": measure}
