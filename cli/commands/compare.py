"""``uplift compare``: which representation of spectra a scene needs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.console import json_text
from ..output.progress import progress_bar
from ..params.options import force_option, format_option
from ..params.study_atlases import SHIPPED, read_each

if TYPE_CHECKING:
    from uplift.lab.comparison.filters import Tuned
    from uplift.lab.comparison.measure import Comparison
    from uplift.lab.comparison.scene import Scene

FILES = ("compare.csv", "compare-boxes.png", "compare-cost.png", "compare.html")
FILTERS = "compare-filters.csv"


@click.command("compare")
@click.option(
    "--atlas", "files", metavar="FILE", multiple=True, help=f"Surfaces; may be repeated. [default: {SHIPPED}]"
)
@click.option(
    "--light",
    "lights",
    metavar="NAME",
    multiple=True,
    help="Light, as colour-science names it; may be repeated. [default: A, B, C, and FL2, FL7, FL11]",
)
@click.option(
    "--target", metavar="ΔE00", type=float, help="Name the cheapest that 97.5 % of errors stay within."
)
@click.option(
    "--filters", is_flag=True, help="Search the best low-pass filters for point sampling too: minutes."
)
@click.option("--quick", is_flag=True, help="Forty surfaces at most, few repeats, a coarse search: seconds.")
@click.option("-o", "--output", metavar="DIR", help="Folder to write tables, pictures and page to.")
@format_option("table", "json", "csv")
@force_option()
def command(
    files: tuple[str, ...],
    lights: tuple[str, ...],
    target: float | None,
    filters: bool,
    quick: bool,
    output: str | None,
    style: str,
    force: bool,
) -> None:
    """Compare representations of spectra, in colour and in cost, for a renderer's lights and surfaces.

    Each multiplies every light with every reflectance of the atlases; ΔE00 to the products of densely sampled
    data: mean, standard deviation, median, quantiles. Point samples (PS, filtered PF), Riemann sums (RS, enhanced
    RE), Sun's composite model (CS), Gaussian quadrature (GQ), trigonometric moments (TM), the sigmoid (SG), linear
    models (LM) and hero wavelengths (HW), by their numbers; what each stores, and what a product takes. With --light
    the lights are those named, in place of a smooth and a spiky set.

    With --target one line for each set of lights names the cheapest representation that is near enough: it stores
    least of a surface, then of a light, then is the nearest. --output writes compare.csv, box plots and the
    chart of error over cost as PNG, a page, and with --filters compare-filters.csv.

    \b
    Examples:
      uplift compare --quick
      uplift compare --target 1.0
      uplift compare --atlas paints.csv --light LED-B3 --light HP1 --target 0.5
      uplift compare --filters --output out
    """
    from ..startup import one_thread

    one_thread()
    if target is not None:
        from uplift.lab.comparison.recommend import check_target

        check_target(target)
    folder = _folder(output, filters=filters, force=force)
    found, tuned = _measure(files, lights, filters=filters, quick=quick)
    if folder is not None:
        _write(found, tuned, folder, force=force)
    if target is not None:
        from ..output.compare_tables import print_advice

        print_advice(found, target)
        return
    PRINTERS[style](found, tuned)


def _folder(output: str | None, *, filters: bool, force: bool) -> Path | None:
    """Made, and every file asked for, before the work. Raises `OutputError`."""
    from uplift.common.files import check_folder

    if output is None:
        return None
    return check_folder(output, (*FILES, FILTERS) if filters else FILES, force=force)


def _measure(
    files: tuple[str, ...], lights: tuple[str, ...], *, filters: bool, quick: bool
) -> tuple[Comparison, tuple[Tuned, ...]]:
    from uplift.lab.comparison.measure import QUICK, Effort, compare
    from uplift.lab.comparison.scene import scene
    from uplift.scene.representations.registry import all_representations

    asked = scene(read_each(files), lights)
    asked = asked.thinned() if quick else asked
    with progress_bar("representations") as progress:
        effort = QUICK if quick else Effort()
        found = compare(asked, all_representations(asked.powers, asked.surfaces), effort, progress)
    return found, _tune(asked, quick=quick) if filters else ()


def _tune(asked: Scene, *, quick: bool) -> tuple[Tuned, ...]:
    from uplift.lab.comparison.filters import tune
    from uplift.scene.representations.filters import COARSE_STRIDE, FINE_STRIDE

    with progress_bar("filters") as progress:
        return tune(asked, COARSE_STRIDE if quick else FINE_STRIDE, progress=progress)


def _write(found: Comparison, tuned: tuple[Tuned, ...], folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.comparison.page import page
    from uplift.lab.comparison.pictures import write_picture
    from uplift.lab.comparison.table import filter_records, records
    from uplift.lab.study.records import write_csv

    table, boxes, cost, html = (folder / name for name in FILES)
    write_csv(records(found), table, force=force)
    if tuned:
        write_csv(filter_records(tuned), folder / FILTERS, force=force)
    pictures = {
        kind: write_picture(found, kind, path, force=force)
        for kind, path in (("boxes", boxes), ("cost", cost))
    }
    write_text(page(found, pictures, tuned), html, force=force)
    click.echo(f"{folder}: {', '.join((*FILES, FILTERS) if tuned else FILES)}", err=True)


def _print_table(found: Comparison, tuned: tuple[Tuned, ...]) -> None:
    from ..output.compare_tables import print_comparison, print_filters

    print_comparison(found)
    if tuned:
        print_filters(tuned)


def _records(found: Comparison, tuned: tuple[Tuned, ...]) -> dict[str, Any]:
    from uplift.lab.comparison.table import filter_records, records

    return {"facts": dict(found.facts), "representations": records(found), "filters": filter_records(tuned)}


def _print_json(found: Comparison, tuned: tuple[Tuned, ...]) -> None:
    click.echo(json_text(_records(found, tuned)))


def _print_csv(found: Comparison, tuned: tuple[Tuned, ...]) -> None:
    from uplift.lab.study.records import csv_text

    told = _records(found, tuned)
    for part in ("representations", "filters"):
        if told[part]:
            click.echo(csv_text(told[part]), nl=False)


PRINTERS: dict[str, Callable[[Comparison, tuple[Tuned, ...]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
