"""``uplift chart``: speed and accuracy of upsampling methods, and a recommendation of
the cube to build.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import click

from .. import options
from ..inputs import DEFAULT_ATLASES, atlas_files, read_atlases
from ..output.console import paragraph, say
from ..output.progress import progress_bar
from ..output.table import Table, print_result
from ..outputs import check_folder, write_files
from ..startup import enable_jit_cache, use_one_blas_thread

if TYPE_CHECKING:
    from uplift.lab.chart.results import Chart

PRINTED = 3
"""Pareto fronts of each number of colours that are printed; the page has all."""
FILES = ("chart.csv", "chart.png", "chart.html")


@click.command(
    "chart",
    help="""Measure speed and accuracy of spectral upsampling methods, of this package
    and from the literature.

    Every method processes the same colours and measured spectra, with 1, 1000, 65536
    and a million colours per call. The table has these times, time and size of the
    build, the error of round trips at 1 nm with the white and matrix that the method
    states, ΔE00 of unseen materials under A, FL2, FL7, FL11 and LED-B3, and the error
    of their spectra. Odd entries of every atlas build the cubes, even entries test
    them. Methods with wrong results are listed but not timed, as are those that are not
    installed.

    Writes chart.csv, chart.png and chart.html, and prints the Pareto fronts.

    \b
    Examples:
      uplift chart --quick
      uplift chart --method 'moments9-32-*' --method mallett2019 -o few
      uplift chart --recommend
      uplift chart --recommend --time-ns 500
      uplift chart --recommend --tolerance 0.5 --light FL11 --atlas-materials
      uplift chart --recommend --from few/chart.csv --tolerance 5
    """,
)
@options.output(help="Folder to write to.", metavar="DIR", default="chart")
@options.repeatable(
    "--method", "patterns", "Methods by name, with '*' as a wildcard", metavar="PATTERN"
)
@options.atlas("Measured spectra", DEFAULT_ATLASES)
@options.flag(
    "--quick", help="Few methods and repeats: about a minute instead of half an hour."
)
@click.option(
    "--from",
    "source",
    metavar="CSV",
    help="Table of an earlier chart to draw or to recommend from.",
)
@options.flag(
    "--recommend",
    help="Recommend a cube for common situations, or for limits, by the packaged chart "
    "or --from.",
)
@options.number("--time-ns", help="With --recommend: largest CPU time per RGB, in ns.")
@options.tolerance("delta_e", help="With --recommend: largest mean ΔE00.")
@click.option(
    "--light",
    help="With --recommend: illuminant of the ΔE00; D65 is the round trip. [default: "
    "mean of five]",
)
@options.flag(
    "--atlas-materials",
    "own",
    help="With --recommend: ΔE00 of the atlas entries instead of unseen materials.",
)
@options.force
def command(
    output: str,
    patterns: tuple[str, ...],
    files: tuple[str, ...],
    quick: bool,
    source: str | None,
    recommend: bool,
    force: bool,
    **required: Any,
) -> None:
    enable_jit_cache()
    use_one_blas_thread()
    if recommend:
        _recommend(source, required)
        return
    if any(required.values()):
        raise click.UsageError("The limits of a recommendation require --recommend.")
    from uplift.common.files import write_text
    from uplift.lab.chart.picture import render_chart, write_picture
    from uplift.lab.chart.results import chart_csv, read_chart

    check_folder(output, FILES, inputs=atlas_files(files))
    if source is None:
        chart = _measure(files, patterns, quick=quick)
    else:
        chart = read_chart(source)
    table = partial(write_text, chart_csv(chart))
    page = partial(write_text, render_chart(chart))
    write_files(output, FILES, table, partial(write_picture, chart), page)
    _print_fronts(chart)


def _recommend(source: str | None, required: dict[str, Any]) -> None:
    """Print the cube that meets the requirement, or those of common situations."""
    from uplift.extras.pages.format import format_error, format_size, format_time
    from uplift.lab.chart.recommendation import (
        SITUATIONS,
        Requirement,
        recommend_cube,
    )
    from uplift.lab.chart.results import read_chart, shipped_chart

    chart = read_chart(source) if source is not None else shipped_chart()
    situations = SITUATIONS
    if any(required.values()):
        situations = {"": Requirement(**required)}
    for title, requirement in situations.items():
        row = recommend_cube(chart, requirement)
        paragraph(
            f"{title}{': ' * bool(title)}{row.title}: "
            f"{format_time(row.numbers['time_ns'])} per RGB, mean ΔE00 "
            f"{format_error(requirement.error_of(row))} "
            f"{requirement.description}, {format_size(row.numbers['bytes'])}"
        )
        say(f"  {row.build}")
        say(f"  {row.call}")


def _measure(
    files: tuple[str, ...], patterns: tuple[str, ...], *, quick: bool
) -> Chart:
    from uplift.lab.chart.measure import measure_methods
    from uplift.lab.chart.selection import QUICK_METHODS, select_methods
    from uplift.lab.chart.task import QUICK, Effort, make_task

    methods = select_methods(patterns or (QUICK_METHODS if quick else ()))
    task = make_task(read_atlases(files), QUICK if quick else Effort())
    with progress_bar("methods") as progress:
        return measure_methods(methods, task, progress)


def _print_fronts(chart: Chart) -> None:
    from uplift.extras.pages.format import format_error, format_size, format_time
    from uplift.lab.chart.results import State, criteria

    say("Pareto fronts, from the fastest to the most accurate")
    formats = {"time": format_time, "error": format_error, "bytes": format_size}
    tables = []
    for batch in chart.batches:
        for criterion in criteria(batch)[:PRINTED]:
            rows = []
            for result, (time, error) in criterion.front(chart.measured).items():
                size = result.numbers["bytes"]
                row = {"method": result.method, "time": time, "error": error}
                rows.append(row | {"bytes": size})
            title = f"{criterion.title}: {criterion.colours}"
            headings = {key: key for key in ("method", "time", "error", "bytes")}
            headings["error"] = criterion.unit
            tables.append(Table(rows, headings, title, formats=formats))
    print_result("table", None, *tables)
    for result in chart.results:
        if result.state != State.MEASURED:
            say(f"{result.method}: {result.state}, not drawn: {result.why}")
