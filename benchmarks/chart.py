"""Speed and accuracy of all methods: ``make chart``.

Writes docs/data/chart.json, the pictures of docs/chart, and the table that the package carries.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click
from uplift_cli.startup import enable_jit_cache, use_one_blas_thread

from benchmarks.record import ROOT, write
from uplift.colorimetry.lights import CHART_LIGHTS

if TYPE_CHECKING:
    from uplift.lab.chart.table import Chart, MethodResult

ERRORS = (*CHART_LIGHTS, "rms", "own_lights")


@click.command()
@click.option("--from", "source", metavar="CSV", help="Table of an earlier run; nothing is measured.")
def main(source: str | None) -> None:
    """Measure, draw and store."""
    enable_jit_cache()
    use_one_blas_thread()
    publish(_measure() if source is None else _read(source))


def _read(source: str) -> Chart:
    from uplift.lab.chart.table import read_chart

    return read_chart(source)


def _measure() -> Chart:
    from uplift.atlas import read_atlas
    from uplift.lab.chart.measure import measure_methods
    from uplift.lab.chart.methods import select_methods
    from uplift.lab.chart.task import make_task

    atlases = {path.stem: read_atlas(path) for path in sorted((ROOT / "atlases").glob("*.txt"))}
    methods = select_methods()
    with click.progressbar(length=len(methods), label="methods", file=sys.stderr) as bar:
        return measure_methods(methods, make_task(atlases), lambda done: bar.update(1))


def publish(chart: Chart) -> None:
    """Write the table, the pictures and the data of the page."""
    from uplift.common.files import check_folder, write_text
    from uplift.lab.chart.page import render_chart
    from uplift.lab.chart.picture import write_pictures
    from uplift.lab.chart.recommend import MEASURED
    from uplift.lab.chart.table import chart_csv

    folder = check_folder(ROOT / "docs" / "chart", (), force=True)
    write_text(chart_csv(chart), ROOT / "uplift" / "lab" / "chart" / MEASURED, force=True)
    write_pictures(chart, folder / "chart.png", folder / "chart.svg", force=True)
    write_text(render_chart(chart), folder / "chart.html", force=True)
    store(chart)


def store(chart: Chart) -> None:
    """Write docs/data/chart.json."""
    from uplift.lab.chart.table import State

    write(
        "chart",
        "make chart",
        environment=dict(chart.facts),
        fronts=fronts(chart),
        methods=[method_record(row) for row in chart.measured],
        excluded=[
            {"method": row.title, "state": row.state, "reason": row.why}
            for row in chart.results
            if row.state != State.MEASURED
        ],
    )


def fronts(chart: Chart) -> list[dict[str, Any]]:
    """Return the Pareto front of every panel, fastest first; the panel is named in its first row."""
    from uplift.lab.chart.panels import PANELS

    rows = []
    for panel in PANELS:
        seconds = 1.0 if panel.time == "build_s" else 1e-9
        front = panel.front(chart)
        rows += [
            {
                "panel": panel.title if row is front[0] else "",
                "method": row.title,
                "time_s": row.numbers[panel.time] * seconds,
                "error": row.numbers[f"{panel.error}_mean"],
            }
            for row in front
        ]
    return rows


def method_record(row: MethodResult) -> dict[str, Any]:
    """Return the figures of a method: times in ns, sizes in bytes."""
    numbers = row.numbers
    return {
        "method": row.title,
        "batch": _spread(row, "batch_ns"),
        "single": _spread(row, "single_ns"),
        "bytes": numbers["bytes"],
        "build_s": numbers.get("build_s"),
        "round_trip": [numbers[f"round_trip_{kind}"] for kind in ("mean", "p99", "max")],
        "errors": {name: numbers[f"{name}_mean"] for name in ERRORS},
        "colours": int(numbers["round_trip_colours"]),
        "materials": int(numbers["unseen_spectra"]),
        "note": row.note,
    }


def _spread(row: MethodResult, key: str) -> dict[str, float] | None:
    if key not in row.numbers:
        return None
    return {"median": row.numbers[key], "min": row.numbers[f"{key}_least"], "max": row.numbers[f"{key}_most"]}


if __name__ == "__main__":
    main()
