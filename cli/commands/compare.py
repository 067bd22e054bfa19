"""``uplift lab compare``: accuracy and cost of representations for a renderer."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import click

from uplift.common.files import write_text
from uplift.common.text import pluralise

from .. import options
from ..inputs import DEFAULT_ATLASES, atlas_files, read_atlases
from ..output.console import say
from ..output.progress import progress_bar
from ..output.table import Table, print_result
from ..outputs import check_folder, write_files
from ..startup import use_one_blas_thread

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.papers.representations.compare import Comparison, Row

FILES = ("compare-boxes.png", "compare-cost.png", "compare.html")
SPECTRA = ("surfaces.csv", "lights.csv")


@click.command(
    "compare",
    help="""Compare representations of spectra for a renderer's lights and surfaces, by
    colour error and cost.

    Every light is multiplied with every reflectance of the atlases. The table has ΔE00
    to the products of densely sampled spectra, the number of floats stored, and the
    time of a product, for representations that no other beats in floats and error.
    --light replaces the default lights, a smooth and a spiky set.

    Representations: point samples (PS, filtered PF), Riemann sums (RS, enhanced RE),
    Sun's composite model (CS), Gaussian quadrature (GQ), trigonometric moments (TM),
    the sigmoid (SG), linear models (LM), hero wavelengths (HW). Fitted to the scene:
    wavelengths (FW), Bergner's factor model (BF), moments as cubes have them (CM).

    --tolerance prints the cheapest sufficient representation for each set of lights.
    The cheapest stores the fewest floats per surface, then per light. --output writes
    box plots, a plot of error over cost, and a page.

    --write writes spectra at 1 nm that have the colours of a representation or filter:
    surfaces.csv can be the --atlas of other commands, lights.csv the lamps of uplift
    lights build.

    \b
    Examples:
      uplift lab compare --quick
      uplift lab compare --quick --all
      uplift lab compare --tolerance 1.0
      uplift lab compare --atlas paints.csv --light HP1 --tolerance 0.5
      uplift lab compare --filters --output filters --force
      uplift lab compare --atlas paints.csv --light FL11 --write PF16 -o filtered
    """,
)
@options.atlas("Surfaces", DEFAULT_ATLASES)
@options.light("Illuminant", "A, B, C, and FL2, FL7, FL11")
@options.tolerance(
    help="Print the cheapest representation with 97.5 % of errors below this value."
)
@options.flag(
    "--filters",
    help=(
        "Also search the best low-pass filters for point sampling, which takes minutes."
    ),
)
@options.flag(
    "--all", "every", help="Print all representations, not the Pareto front alone."
)
@options.flag(
    "--quick", help="At most forty surfaces, few repeats and a coarse search: seconds."
)
@click.option(
    "--write",
    metavar="NAME",
    help="Write surfaces and lights as a representation or filter stores them to "
    "--output, and compare nothing: PS16, PF16, RS32, TM9, SG3, or "
    "PS16:KIND:EXTENT:PARAMETERS with a filter, such as PS16:gaussian:7:0.5.",
)
@options.output(help="Folder for tables and plots.", metavar="DIR")
@options.table_json_or_csv
@options.force
def command(
    files: Sequence[str],
    lights: Sequence[Illuminant],
    tolerance: float | None,
    filters: bool,
    every: bool,
    quick: bool,
    write: str | None,
    output: str | None,
    style: str,
    force: bool,
) -> None:
    use_one_blas_thread()
    from uplift.extras.papers.representations.compare import check_target

    if write is not None:
        if output is None or filters or tolerance is not None:
            raise click.UsageError(
                "--write requires --output, and does not apply to --filters and "
                "--tolerance."
            )
        _write_spectra(write, files, lights, output)
        return
    if tolerance is not None:
        check_target(tolerance)
    check_folder(output, FILES, inputs=atlas_files(files))
    comparison, tuned = _measure(files, lights, filters=filters, quick=quick)
    if output is not None:
        from uplift.extras.papers.representations.pictures import (
            render_comparison,
            write_boxes,
            write_costs,
        )

        write_files(
            output,
            FILES,
            partial(write_boxes, comparison),
            partial(write_costs, comparison),
            partial(write_text, render_comparison(comparison, tuned)),
        )
    if tolerance is not None:
        _print_advice(comparison, tolerance)
    elif style == "table":
        _print_table(comparison, tuned, every=every)
    else:
        rows = {"representations": comparison.rows, "filters": tuned}
        data = {"facts": dict(comparison.facts), **rows}
        print_result(style, data, *map(Table, rows.values()))


def _write_spectra(
    name: str, files: Sequence[str], lights: Sequence[Illuminant], output: str
) -> None:
    from uplift.atlas.atlas import merge
    from uplift.atlas.sources import write_atlas
    from uplift.extras.papers.representations.compare import make_scene, represent
    from uplift.extras.papers.representations.registry import find_representation

    representation = find_representation(name)
    check_folder(output, SPECTRA, inputs=atlas_files(files))
    atlases = read_atlases(files)
    pair = represent(
        representation, make_scene(atlases, lights), merge(atlases.values()).names
    )
    write_files(output, SPECTRA, *(partial(write_atlas, atlas) for atlas in pair))
    surfaces = pluralise(len(pair[0]), "surface")
    powers = pluralise(len(pair[1]), "light")
    say(f"{output}: {surfaces} and {powers} as {representation.name}")


def _measure(
    files: Sequence[str],
    lights: Sequence[Illuminant],
    *,
    filters: bool,
    quick: bool,
) -> tuple[Comparison, list[Row]]:
    from uplift.extras.papers.representations.compare import compare, make_scene
    from uplift.extras.papers.representations.fitted import scene_representations
    from uplift.extras.papers.representations.tuning import (
        COARSE_STRIDE,
        FINE_STRIDE,
        tune_filters,
    )
    from uplift.extras.scene.passes.representation import pass_representations

    scene = make_scene(read_atlases(files), lights)
    if quick:
        scene = scene.thinned()
    with progress_bar("representations") as progress:
        comparison = compare(
            scene,
            (*scene_representations(scene), *pass_representations()),
            quick=quick,
            progress=progress,
        )
    if not filters:
        return comparison, []
    with progress_bar("filters") as progress:
        return comparison, tune_filters(
            scene, COARSE_STRIDE if quick else FINE_STRIDE, progress=progress
        )


def _print_advice(comparison: Comparison, tolerance: float) -> None:
    from uplift.extras.pages.format import format_error, format_time
    from uplift.extras.papers.representations.compare import cheapest

    for name, title in comparison.sets.items():
        rows = comparison.of(name)
        row = cheapest(rows, tolerance)
        if row is None:
            best = min(rows, key=itemgetter("q97_5"))
            name, error = best["representation"], format_error(best["q97_5"])
            text = f"none; the most accurate, {name}, has {error}"
        else:
            text = (
                f"{row['representation']} ({row['family']}): 97.5 % below "
                f"{format_error(row['q97_5'])}, {row['floats']:.4g} floats per "
                f"surface, {row['light_floats']:.4g} per light, "
                f"{format_time(row['ns'])} per product"
            )
        say(f"{title}: {text}")


def _print_table(comparison: Comparison, tuned: list[Row], *, every: bool) -> None:
    from uplift.extras.pages.format import format_time
    from uplift.extras.papers.representations.compare import HEADINGS, pareto

    headings = {
        "representation": "representation",
        "mean": "mean",
        "median": "median",
        "q97_5": "97.5 %",
        "floats": "floats",
        "light_floats": "of a light",
        "ns": "product",
    }
    formats: dict[str, Any] = {"floats": ".1f", "light_floats": ".1f"}
    formats["ns"] = format_time
    tables = []
    for name, title in comparison.sets.items():
        rows = comparison.of(name)
        shown = rows if every else pareto(rows)
        title = f"ΔE00 under {title}"
        tables.append(Table(shown, headings, title, formats=formats))
    if tuned:
        rows = sorted(tuned, key=itemgetter("lights", "samples", "mean"))
        texts = {key: key for key in ("lights", "samples", "filter", "parameters")}
        title = "point sampling after the best low-pass filter of each kind"
        tables.append(Table(rows, texts | HEADINGS, title))
    print_result("table", None, *tables)
