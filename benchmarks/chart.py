"""Speed and accuracy of all methods, for docs/speed.md and its pictures, and for
``uplift chart --recommend``.
"""

from benchmarks import DOCS, Row, show
from benchmarks.materials import read_atlases
from uplift.common.files import write_text
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.lab.chart.measure import measure_methods
from uplift.lab.chart.picture import render_chart, write_picture
from uplift.lab.chart.results import (
    MEASURED,
    chart_csv,
    shipped_chart,
)
from uplift.lab.chart.selection import select_methods
from uplift.lab.chart.task import make_task


def measure() -> None:
    """Measure, and write the table that the package carries, from which `figures` are,
    and the pictures.
    """
    chart = measure_methods(select_methods(), make_task(read_atlases()), show)
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
        "methods": methods,
        "is_complete": len(chart.measured) == len(chart.results),
    }


QUESTIONS = {"methods": measure}
