"""``uplift bounds``: what reflectances of one colour can do under other lights."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from uplift.common.files import write_text

from .. import options
from ..output.answers import as_lists, format_rgb, hex_code, patch
from ..output.console import (
    json_output,
    make_table,
    print_csv,
    print_fields,
    print_json_answers,
    say,
    show,
)
from ..output.query_blocks import json_objects
from ..outputs import check_outputs
from .query import Answers, colour_options

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.colour.query import QueryBlock
    from uplift.extras.looks.metamer_bounds import Bounds
    from uplift.lookup import Cube

Block = tuple["QueryBlock", Sequence["Bounds"]]
"""Answers, and their bounds under each light."""
DIVISIONS = 2
"""Density of the directions of bounds: 162 of each of many colours."""
SINGLE_DIVISIONS = 3
"""That of a single colour: 642."""
COLUMNS = (
    *("r", "g", "b", "light", "L*", "a*", "b*", "standard_error", "error_bound"),
    *("largest", "outer"),
    *("L*_min", "a*_min", "b*_min", "L*_max", "a*_max", "b*_max", "share"),
)
"""Columns of CSV."""


@click.command(
    "bounds",
    cls=options.Command,
    everyday=("cube_path", "encoded", "lights", "style", "plot_path", "html"),
    help="""Compute the bounds of all reflectances of a COLOUR: R G B, '#rrggbb', or '-'
    for lines on standard input.

    RGB does not identify a material: others of the same colour may differ under another
    light. Under each --light, the bounds are the largest ΔE00 of any reflectance of the
    colour from the answer of the cube ("ΔE max"; "ΔE 95%" for materials like the
    atlas), and the ranges of L*, a* and b* among sampled extremes, whose ends can lie
    some units further out. "share" is their volume relative to all colours of
    reflectances under the light.

    \b
    Examples:
      uplift bounds '#8a2a20'
      uplift bounds '#8a2a20' --light A --light FL11 --plot bounds.png
      uplift bounds '#8a2a20' --light A --light FL11 --html red.html
      uplift bounds --cube macbeth-32.uplift 0.8 0.2 0.1 --format json

    The page of --html shows the bounds of one colour and a spectrum for every choice in
    them; it writes the TOML for 'uplift build --look'.
    """,
)
@colour_options
@options.light("Illuminant under which the bounds are shown", "A FL11 HP1")
@options.table_json_or_csv
@options.plot("Plot the bounds")
@options.page(
    "Write a page on which the colour under each --light is dragged within its "
    "bounds, for a file of looks."
)
@options.force
def command(
    lights: Sequence[Illuminant],
    style: str,
    plot_path: str | None,
    html: str | None,
    force: bool,
    **colours: Any,
) -> None:
    from uplift.extras.colour.light_sets import RELIGHT_LIGHTS

    check_outputs(plot_path, html)
    answers = Answers(lights=lights or RELIGHT_LIGHTS, **colours)
    if html is not None and not answers.single:
        raise click.UsageError("--html shows one colour: give it on the command line.")
    blocks: Iterable[Block] = map(partial(_compute, answers), answers)
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_bounds

        blocks = list(blocks)
        by_light = [bounds for _, bounds in blocks]
        plot_bounds(answers.cube, by_light, plot_path, force=force)
        say(f"{plot_path}: bounds", err=True)
    if html is not None:
        from uplift.extras.report.look_page import page

        blocks = list(blocks)
        [(_, bounds)] = blocks
        write_text(page(answers.cube, bounds), html, force=force)
        say(f"{html}: page to choose a look on", err=True)
    if style == "json":
        objects = (_objects(answers, *block) for block in blocks)
        print_json_answers(objects, single=answers.single)
    elif style == "csv":
        print_csv(COLUMNS, chain.from_iterable(_rows(*block) for block in blocks))
    else:
        _print_table(answers.cube, blocks, single=answers.single)


def _compute(answers: Answers, results: QueryBlock) -> Block:
    from uplift.extras.looks.metamer_bounds import bounds

    divisions = SINGLE_DIVISIONS if answers.single else DIVISIONS
    return results, [
        bounds(answers.cube, results.rgb, light, answers.mode, divisions)
        for light in answers.lights
    ]


def _objects(
    answers: Answers, results: QueryBlock, by_light: Sequence[Bounds]
) -> Iterable[str]:
    from uplift.colorimetry import lab
    from uplift.extras.looks.lab_errors import LIKELY

    for row, text in enumerate(json_objects(answers, results)):
        fields = {}
        for bounds in by_light:
            largest = bounds.largest
            likely = bounds.likely(row)
            covariance = bounds.covariance
            fields[bounds.light.name] = {
                "lab": bounds.lab[row].tolist(),
                "largest_delta_e_2000": float(largest.delta_e_2000[row]),
                "largest_lab": lab(largest.xyz[row], bounds.light.white).tolist(),
                "outer_delta_e_2000": float(largest.outer[row]),
                "lab_range": bounds.box[row].tolist(),
                "share": float(bounds.share[row]),
                "outline": bounds.outline(row).tolist(),
                "covariance": None if covariance is None else covariance[row].tolist(),
                "likely": None if likely is None else likely.tolist(),
                "likely_share": LIKELY,
            }
        yield f"{text[:-1]}, {json_output({'bounds': fields})[1:]}"


def _rows(results: QueryBlock, by_light: Sequence[Bounds]) -> Iterable[list[Any]]:
    """Yield the rows of CSV, of the columns `COLUMNS`."""
    for row, result in enumerate(results):
        for bounds in by_light:
            light = bounds.light.name
            yield [
                *as_lists(result.rgb),
                light,
                *bounds.lab[row].tolist(),
                result.standard_errors.get(light),
                result.error_bounds.get(light),
                float(bounds.largest.delta_e_2000[row]),
                float(bounds.largest.outer[row]),
                *bounds.box[row].ravel().tolist(),
                float(bounds.share[row]),
            ]


def _print_table(cube: Cube, blocks: Iterable[Block], *, single: bool) -> None:
    from uplift.extras.looks.lab_errors import LIKELY

    for number, (results, by_light) in enumerate(blocks):
        if single:
            rgb = results.rgb[0]
            print_fields(
                {"linear RGB": f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"},
                {"linear RGB": patch(cube, rgb)},
            )
            say()
        table = make_table(
            ("hex",) * (not single) + ("light",),
            ("L* a* b*", f"ΔE {LIKELY:.0%}", "ΔE max", "a* range", "b* range", "share"),
            show_header=number == 0,
        )
        for row, result in enumerate(results):
            code = hex_code(cube, result.rgb)
            for bounds in by_light:
                light = bounds.light.name
                error = result.error_bounds.get(light)
                (_, least_a, least_b), (_, most_a, most_b) = bounds.box[row].tolist()
                table.add_row(
                    *(code,) * (not single),
                    light,
                    " ".join(map("{:.1f}".format, bounds.lab[row])),
                    "–" if error is None else f"{error:.2f}",
                    f"{bounds.largest.delta_e_2000[row]:.2f}",
                    f"{round(least_a)}..{round(most_a)}",
                    f"{round(least_b)}..{round(most_b)}",
                    f"{100 * bounds.share[row]:.2g}%",
                )
                code = ""  # once for all lights
        show(table)
