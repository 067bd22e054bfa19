"""Speed and accuracy of all methods, for docs/chart.md and its pictures, and for ``uplift chart --recommend``."""

from __future__ import annotations

import sys
from typing import Any

from benchmarks import ATLASES, DOCS, ROOT, record
from benchmarks.choices import ALONE, OURS, SHIPPED, mark
from uplift.atlas import read_atlas
from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.files import write_text
from uplift.common.progress import Progress
from uplift.lab.chart.measure import measure_methods, select_methods
from uplift.lab.chart.method import Effort, make_task
from uplift.lab.chart.picture import render_chart, write_panel, write_picture
from uplift.lab.chart.table import MEASURED, Chart, MethodResult, State, chart_csv, criteria, read_chart

ERRORS = (*CHART_LIGHTS, "rms", "own_lights")
UNSEEN = ("lights", "rms")
"""Errors of panels that are those of unseen materials."""
PICTURES = {"unseen": 1, "set-up": 2}
"""Panels of the page, by the first part of the names of their files; each is drawn for every number of colours."""


def main(effort: Effort | None = None) -> None:
    """Measure, draw and store; with the table of an earlier run as an argument, measure nothing."""
    if len(sys.argv) > 1:
        publish(read_chart(sys.argv[1]))
        return
    atlases = {path.stem: read_atlas(path) for path in sorted(ATLASES.glob("*.txt"))}
    publish(measure_methods(select_methods(), make_task(atlases, effort=effort), _print))


def _print(progress: Progress) -> None:
    print(f"{progress.done} of {progress.total} methods", file=sys.stderr)


def publish(chart: Chart) -> None:
    """Write the table that the package carries, the pictures and the data of the page."""
    folder = DOCS / "chart"
    write_text(chart_csv(chart), ROOT / "uplift" / "lab" / "chart" / MEASURED, force=True)
    write_picture(chart, folder / "chart.png", force=True)
    write_text(render_chart(chart), folder / "chart.html", force=True)
    for name, number in PICTURES.items():
        for batch in chart.batches:
            write_panel(chart, criteria(batch)[number], folder / f"{name}-{batch}.png", force=True)
    record(
        "chart",
        environment=dict(chart.facts),
        batches=chart.batches,
        fronts=fronts(chart),
        methods=[method_record(row, chart.batches) for row in chart.measured],
        excluded=[
            {"method": row.title, "state": row.state, "reason": row.why}
            for row in chart.results
            if row.state != State.MEASURED
        ],
    )


def fronts(chart: Chart) -> list[dict[str, Any]]:
    """Return the Pareto front of every panel, fastest first; the panel is named in its first row. Times in ns."""
    rows = []
    for criterion in (criterion for batch in chart.batches for criterion in criteria(batch)):
        front = criterion.front(chart)
        rows += [
            {
                "panel": criterion.title if row is front[0] else "",
                "colours": criterion.batch,
                "method": row.title,
                "time": criterion.time(row),
                "error": row.numbers[f"{criterion.error}_mean"],
                "mark": optimistic_mark(row) if criterion.error in UNSEEN else "",
            }
            for row in front
        ]
    return rows


def method_record(row: MethodResult, batches: tuple[int, ...]) -> dict[str, Any]:
    """Return the figures of a method: times in ns, sizes in bytes."""
    numbers = row.numbers
    return {
        "name": row.method,
        "method": row.title,
        "mark": optimistic_mark(row),
        "dtype": row.dtype,
        "times": {str(batch): _time(row, batch) for batch in batches},
        "totals": {str(batch): 1e9 * numbers["setup_s"] + batch * numbers[f"ns_{batch}"] for batch in batches},
        "spread": max((numbers[f"ns_{batch}_most"] / numbers[f"ns_{batch}_least"] - 1) for batch in batches),
        "bytes": numbers["bytes"],
        "build_s": numbers.get("build_s"),
        "load_s": numbers["load_s"],
        "round_trip": [numbers[f"round_trip_{kind}"] for kind in ("mean", "p99", "max")],
        "coarse_round_trip": [numbers[f"coarse_round_trip_{kind}"] for kind in ("mean", "p99", "max")],
        "errors": {name: numbers[f"{name}_mean"] for name in ERRORS},
        "colours": int(numbers["round_trip_colours"]),
        "materials": int(numbers["unseen_spectra"]),
        "note": row.note,
    }


def optimistic_mark(row: MethodResult) -> str:
    """Return the mark of the errors of unseen materials, which are of all shipped sets.

    The choices are those of cubes of moments; the colour alone determines a sigmoid.
    """
    if not row.build or "--model" in row.build:
        return ""
    return mark(SHIPPED, OURS if "--atlas" in row.build else ALONE)


def _time(row: MethodResult, batch: int) -> dict[str, Any]:
    """Return the median, least and greatest time per RGB, and the mark of calls with fewer colours than the batch."""
    key = f"ns_{batch}"
    return {
        "mark": "≈ " if row.numbers[f"{key}_colours"] < batch else "",
        "median": row.numbers[key],
        "least": row.numbers[f"{key}_least"],
        "most": row.numbers[f"{key}_most"],
    }


if __name__ == "__main__":
    main()
