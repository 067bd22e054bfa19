"""``uplift compare``: accuracy and cost of spectral representations for a renderer."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.console import print_csv_text, print_json, say
from ..output.progress import progress_bar
from ..params.atlases import DEFAULT_ATLASES, read_atlases
from ..params.number_types import NUMBER
from ..params.options import atlas_option, force_option, format_option, light_option, output_folder_option
from ..startup import use_one_blas_thread

if TYPE_CHECKING:
    from uplift.lab.comparison.compare import Comparison, Scene
    from uplift.lab.comparison.filters import TunedFilter

FILES = ("compare.csv", "compare-boxes.png", "compare-cost.png", "compare.html")
FILTERS = "compare-filters.csv"


@click.command("compare")
@atlas_option("Surfaces", DEFAULT_ATLASES)
@light_option("Illuminant", "A, B, C, and FL2, FL7, FL11")
@click.option(
    "--tolerance",
    "target",
    metavar="ΔE00",
    type=NUMBER,
    help="Print the cheapest representation with 97.5 % of errors below this value.",
)
@click.option(
    "--filters",
    is_flag=True,
    help="Also search the best low-pass filters for point sampling, which takes minutes.",
)
@click.option("--quick", is_flag=True, help="At most forty surfaces, few repeats and a coarse search: seconds.")
@output_folder_option()
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
    """Compare representations of spectra for a renderer's lights and surfaces, by colour error and cost.

    Every light is multiplied with every reflectance of the atlases. The table has ΔE00 to the products of densely
    sampled spectra, the number of floats stored, and the time of a product. --light replaces the default lights, a
    smooth and a spiky set.

    Representations: point samples (PS, filtered PF), Riemann sums (RS, enhanced RE), Sun's composite model (CS),
    Gaussian quadrature (GQ), trigonometric moments (TM), the sigmoid (SG), linear models (LM), hero wavelengths (HW).

    --tolerance prints the cheapest sufficient representation for each set of lights. The cheapest stores the fewest
    floats per surface, then per light. --output writes compare.csv, box plots, a plot of error over cost, a page, and
    with --filters compare-filters.csv.

    \b
    Examples:
      uplift compare --quick
      uplift compare --tolerance 1.0
      uplift compare --atlas paints.csv --light LED-B3 --light HP1 --tolerance 0.5
      uplift compare --filters --output filters --force
    """
    use_one_blas_thread()
    if target is not None:
        from uplift.lab.comparison.compare import check_target

        check_target(target)
    folder = _folder(output, files, filters=filters, force=force)
    comparison, tuned = _measure(files, lights, filters=filters, quick=quick)
    if folder is not None:
        _write(comparison, tuned, folder, force=force)
    if target is not None:
        from ..output.compare_tables import print_advice

        print_advice(comparison, target)
        return
    PRINTERS[style](comparison, tuned)


def _folder(output: str | None, inputs: tuple[str, ...], *, filters: bool, force: bool) -> Path | None:
    """Create the output folder and check its files before the work. Raises `OutputError`."""
    from uplift.common.files import check_folder

    if output is None:
        return None
    names = (*FILES, FILTERS) if filters else FILES
    return check_folder(output, names, inputs=inputs, force=force)


def _measure(
    files: tuple[str, ...], lights: tuple[str, ...], *, filters: bool, quick: bool
) -> tuple[Comparison, tuple[TunedFilter, ...]]:
    from uplift.lab.comparison.compare import QUICK, TimingOptions, compare, make_scene
    from uplift.scene.representations import all_representations

    tested = make_scene(read_atlases(files), lights)
    tested = tested.thinned() if quick else tested
    with progress_bar("representations") as progress:
        effort = QUICK if quick else TimingOptions()
        comparison = compare(tested, all_representations(tested.powers, tested.surfaces), effort, progress)
    return comparison, _tune(tested, quick=quick) if filters else ()


def _tune(tested: Scene, *, quick: bool) -> tuple[TunedFilter, ...]:
    from uplift.lab.comparison.filters import tune_filters
    from uplift.scene.representations.filters import COARSE_STRIDE, FINE_STRIDE

    with progress_bar("filters") as progress:
        return tune_filters(tested, COARSE_STRIDE if quick else FINE_STRIDE, progress=progress)


def _write(comparison: Comparison, tuned: tuple[TunedFilter, ...], folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.comparison.compare import records
    from uplift.lab.comparison.filters import filter_records
    from uplift.lab.comparison.pictures import render_comparison, write_picture
    from uplift.lab.records import write_csv

    table, boxes, cost, html = (folder / name for name in FILES)
    write_csv(records(comparison), table, force=force)
    if tuned:
        write_csv(filter_records(tuned), folder / FILTERS, force=force)
    for kind, path in (("boxes", boxes), ("cost", cost)):
        write_picture(comparison, kind, path, force=force)
    write_text(render_comparison(comparison, tuned), html, force=force)
    say(f"{folder}: {', '.join((*FILES, FILTERS) if tuned else FILES)}", err=True)


def _print_table(comparison: Comparison, tuned: tuple[TunedFilter, ...]) -> None:
    from ..output.compare_tables import print_comparison, print_filters

    print_comparison(comparison)
    if tuned:
        print_filters(tuned)


def _records(comparison: Comparison, tuned: tuple[TunedFilter, ...]) -> dict[str, Any]:
    from uplift.lab.comparison.compare import records
    from uplift.lab.comparison.filters import filter_records

    return {
        "facts": dict(comparison.facts),
        "representations": records(comparison),
        "filters": filter_records(tuned),
    }


def _print_json(comparison: Comparison, tuned: tuple[TunedFilter, ...]) -> None:
    print_json(_records(comparison, tuned))


def _print_csv(comparison: Comparison, tuned: tuple[TunedFilter, ...]) -> None:
    from uplift.lab.records import records_csv

    tables = _records(comparison, tuned)
    for name in ("representations", "filters"):
        if tables[name]:
            print_csv_text(records_csv(tables[name]))


PRINTERS: dict[str, Callable[[Comparison, tuple[TunedFilter, ...]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
