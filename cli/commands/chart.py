"""``uplift chart``: speed against accuracy of every method, and which cube to build."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..output.console import console
from ..output.progress import progress_bar
from ..params.options import force_option
from ..params.study_atlases import SHIPPED, read_each

if TYPE_CHECKING:
    from uplift.lab.chart.recommend import Wish
    from uplift.lab.chart.table import Chart

FILES = ("chart.csv", "chart.png", "chart.svg", "chart.html")


@click.command("chart")
@click.option("-o", "--output", metavar="DIR", default="chart", show_default=True, help="Folder to write to.")
@click.option(
    "--methods",
    "patterns",
    metavar="PATTERN",
    multiple=True,
    help="Methods by name, '*' for any; may be repeated.",
)
@click.option(
    "--atlas",
    "files",
    metavar="FILE",
    multiple=True,
    help=f"Measured spectra; may be repeated. [default: {SHIPPED}]",
)
@click.option(
    "--colours", metavar="N", default=2000, show_default=True, help="Random colours of the round trip."
)
@click.option("--quick", is_flag=True, help="Few methods, few repeats: a minute in place of ten.")
@click.option("--from", "source", metavar="CSV", help="Draw a chart measured before, or recommend from it.")
@click.option(
    "--recommend", is_flag=True, help="Say which cube to build, from the chart of docs/chart.md or --from."
)
@click.option("--time-ns", type=float, help="With --recommend: CPU time that an RGB may take, in ns.")
@click.option("--delta-e", type=float, help="With --recommend: mean ΔE00 that answers may be off.")
@click.option(
    "--light", help="With --recommend: light of the ΔE00, D65 for round trips. [default: mean of five]"
)
@click.option("--own", is_flag=True, help="With --recommend: the ΔE00 is that of the atlas's own materials.")
@force_option()
def command(
    output: str,
    patterns: tuple[str, ...],
    files: tuple[str, ...],
    colours: int,
    quick: bool,
    source: str | None,
    recommend: bool,
    time_ns: float | None,
    delta_e: float | None,
    light: str | None,
    own: bool,
    force: bool,
) -> None:
    """Chart the speed of spectral upsampling against its accuracy: ours, and other published methods.

    Each method answers the same colours and measured spectra: the round trip, unseen materials under A, FL2, FL7,
    FL11 and LED-B3, their spectra, and what building takes. Of every atlas the first, third, … entry builds the
    cubes with an atlas, the others are asked for. What answers wrongly is listed, and not timed. Writes chart.csv,
    chart.png, chart.svg and chart.html, and tells the Pareto fronts.

    \b
    Examples:
      uplift chart --quick
      uplift chart --atlas paints.csv -o paints
      uplift chart --methods 'moments9-32-*' --methods mallett2019 -o few
      uplift chart --recommend --time-ns 500
      uplift chart --recommend --delta-e 0.5 --light FL11 --own
      uplift chart --recommend --from paints/chart.csv --delta-e 1
    """
    from ..startup import keep_compiled, one_thread

    keep_compiled()
    one_thread()
    wishes = (time_ns, delta_e, light, own or None)
    if recommend:
        from uplift.lab.chart.recommend import Wish

        _recommend(source, Wish(time_ns, delta_e, light, own))
        return
    if any(wish is not None for wish in wishes):
        raise click.UsageError("--time-ns, --delta-e, --light and --own go with --recommend.")
    folder = _folder(output, force=force)
    found = _read(source) if source is not None else _measure(files, patterns, colours, quick=quick)
    _write(found, folder, force=force)
    _tell(found, folder)


def _recommend(source: str | None, wish: Wish) -> None:
    from uplift.lab.chart.recommend import recommend, shipped
    from uplift.viz.format import format_error, format_size, format_time

    row = recommend(_read(source) if source is not None else shipped(), wish)
    numbers = row.numbers
    click.echo(
        f"{row.title}: {format_time(numbers['time_ns'])} per RGB, mean ΔE00 {format_error(numbers[wish.error])} "
        f"{wish.about}, {format_size(numbers['bytes'])}\n  {row.build}\n  {row.ask}"
    )


def _read(source: str) -> Chart:
    from uplift.lab.chart.table import read_chart

    return read_chart(source)


def _folder(output: str, *, force: bool) -> Path:
    """Made, and every file asked for, before the work. Raises `OutputError`."""
    from uplift.common.files import check_folder

    return check_folder(output, FILES, force=force)


def _measure(files: tuple[str, ...], patterns: tuple[str, ...], colours: int, *, quick: bool) -> Chart:
    from uplift.lab.chart.measure import measure
    from uplift.lab.chart.methods import chosen
    from uplift.lab.chart.task import QUICK, Effort, task

    methods = chosen(patterns, quick=quick)
    asked = task(read_each(files), colours, QUICK if quick else Effort())
    with progress_bar("methods") as progress:
        return measure(methods, asked, progress)


def _write(found: Chart, folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.chart.page import page
    from uplift.lab.chart.picture import write_pictures
    from uplift.lab.chart.table import csv_text

    table, png, svg, html = (folder / name for name in FILES)
    write_text(csv_text(found), table, force=force)
    picture = write_pictures(found, png, svg, force=force)
    write_text(page(found, picture), html, force=force)


def _tell(found: Chart, folder: Path) -> None:
    from rich import box
    from rich.table import Table

    from uplift.lab.chart.panels import PANELS
    from uplift.lab.chart.table import State
    from uplift.viz.format import format_size

    table = Table(box=box.SIMPLE_HEAD, caption="Pareto fronts, from the quickest to the nearest")
    for heading in ("", "method"):
        table.add_column(heading, no_wrap=True)
    for heading in ("time", "error", "bytes"):
        table.add_column(heading, justify="right", no_wrap=True)
    for panel in PANELS:
        front = panel.front(found)
        for row in front:
            title = panel.title if row is front[0] else ""
            table.add_row(
                title,
                row.method,
                *panel.told(row),
                format_size(row.numbers["bytes"]),
                end_section=row is front[-1],
            )
    console().print(table)
    for row in found.rows:
        if row.state != State.MEASURED:
            click.echo(f"{row.method}: {row.state}, not drawn: {row.why}")
    click.echo(f"{folder}: {', '.join(FILES)}", err=True)
