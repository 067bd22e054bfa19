"""Speed and accuracy of all methods: ``make chart``.

Writes docs/data/chart.json, the pictures of docs/chart, and the table that the package carries.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click
from uplift_cli.startup import enable_jit_cache, use_one_blas_thread

from benchmarks.choices import ALONE, OURS, SHIPPED, mark
from benchmarks.record import ROOT, write
from uplift.colorimetry.lights import CHART_LIGHTS

if TYPE_CHECKING:
    from uplift.lab.chart.table import Chart, MethodResult

ERRORS = (*CHART_LIGHTS, "rms", "own_lights")
UNSEEN = ("lights", "rms")
"""Errors of panels that are those of unseen materials."""
PICTURES = {"unseen": 1, "set-up": 2}
"""Panels of the page, by the first part of the names of their files; each is drawn for every number of colours."""


@click.command()
@click.option("--from", "source", metavar="CSV", help="Table of an earlier run; nothing is measured.")
@click.option("--longest", type=float, help="CPU seconds of a call; slower ones take fewer colours.  [default: 1]")
def main(source: str | None, longest: float | None) -> None:
    """Measure, draw and store."""
    enable_jit_cache()
    use_one_blas_thread()
    publish(_measure(longest) if source is None else _read(source))


def _read(source: str) -> Chart:
    from uplift.lab.chart.table import read_chart

    return read_chart(source)


def _measure(longest: float | None) -> Chart:
    from uplift.atlas import read_atlas
    from uplift.lab.chart.measure import measure_methods
    from uplift.lab.chart.methods import select_methods
    from uplift.lab.chart.task import Effort, make_task

    effort = Effort() if longest is None else Effort(longest=longest)
    atlases = {path.stem: read_atlas(path) for path in sorted((ROOT / "atlases").glob("*.txt"))}
    methods = select_methods()
    with click.progressbar(length=len(methods), label="methods", file=sys.stderr) as bar:
        return measure_methods(methods, make_task(atlases, effort=effort), lambda done: bar.update(1))


def publish(chart: Chart) -> None:
    """Write the table, the pictures and the data of the page."""
    from uplift.common.files import check_folder, write_text
    from uplift.lab.chart.page import render_chart
    from uplift.lab.chart.panels import panels_of
    from uplift.lab.chart.picture import write_panel, write_pictures
    from uplift.lab.chart.recommend import MEASURED
    from uplift.lab.chart.table import chart_csv

    folder = check_folder(ROOT / "docs" / "chart", (), force=True)
    write_text(chart_csv(chart), ROOT / "uplift" / "lab" / "chart" / MEASURED, force=True)
    write_pictures(chart, folder / "chart.png", folder / "chart.svg", force=True)
    write_text(render_chart(chart), folder / "chart.html", force=True)
    for name, number in PICTURES.items():
        for batch in chart.batches:
            write_panel(chart, panels_of(batch)[number], folder / f"{name}-{batch}.png", force=True)
    store(chart)


def store(chart: Chart) -> None:
    """Write docs/data/chart.json."""
    from uplift.lab.chart.table import State

    write(
        "chart",
        "make chart",
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
    from uplift.lab.chart.panels import all_panels

    rows = []
    for panel in all_panels(chart):
        front = panel.front(chart)
        rows += [
            {
                "panel": panel.title if row is front[0] else "",
                "colours": panel.batch,
                "method": row.title,
                "time": panel.time(row),
                "error": row.numbers[f"{panel.error}_mean"],
                "mark": optimistic_mark(row) if panel.error in UNSEEN else "",
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
