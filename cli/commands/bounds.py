"""``uplift bounds``: what reflectances of one colour can do under other lights."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, product
from typing import TYPE_CHECKING, Any

import click

from uplift.common.files import write_text

from .. import options
from ..output.answers import as_lists, format_rgb, hex_code, patch
from ..output.console import (
    make_table,
    print_csv,
    print_fields,
    print_json_answers,
    say,
    show,
)
from ..outputs import check_outputs
from .query import Answers, colour_options, result_object

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.colour.query import QueryResult
    from uplift.extras.looks.metamer_bounds import Bounds
    from uplift.lookup import Cube

Block = tuple[Sequence["QueryResult"], Sequence["Bounds"]]
"""Answers, and their bounds under each light."""
DIVISIONS, SINGLE_DIVISIONS = 2, 3
"""Density of the directions of bounds: 162 of each of many colours, 642 of a single
one.
"""


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
@options.output_format("table", "json", "csv")
@options.plot("Plot the bounds")
@options.page(
    "Write a page on which the colour under each --light is dragged within its "
    "bounds, for a file of looks."
)
@options.force
def command(
    lights: tuple[Illuminant, ...],
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

    blocks = _blocks(answers)
    if plot_path is not None or html is not None:
        blocks = list(blocks)
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_bounds

        shown = [bounds for _, bounds in blocks]
        plot_bounds(answers.cube, shown, plot_path, force=force)
        say(f"{plot_path}: bounds", err=True)
    if html is not None:
        from uplift.extras.report.look_page import page

        _, bounds = next(iter(blocks))
        write_text(page(answers.cube, bounds), html, force=force)
        say(f"{html}: page to choose a look on", err=True)
    if style == "json":
        objects = chain.from_iterable(_objects(answers, *block) for block in blocks)
        print_json_answers(objects, single=answers.single)
    elif style == "csv":
        _print_csv(blocks)
    else:
        _print_table(answers.cube, blocks, single=answers.single)


def _blocks(answers: Answers) -> Iterable[Block]:
    """Yield blocks of the results of a query, and their bounds under each light."""
    import numpy as np

    from uplift.extras.looks.metamer_bounds import bounds

    divisions = SINGLE_DIVISIONS if answers.single else DIVISIONS
    for block in answers:
        rgb = np.stack([result.rgb for result in block])
        yield (
            block,
            [
                bounds(answers.cube, rgb, light, answers.mode, divisions)
                for light in answers.lights
            ],
        )


def _objects(
    answers: Answers, results: Sequence[QueryResult], found: Sequence[Bounds]
) -> Iterable[dict[str, Any]]:
    from uplift.colorimetry import lab
    from uplift.extras.looks.lab_errors import LIKELY

    for row, result in enumerate(results):
        fields = {}
        for each in found:
            likely = each.likely(row)
            fields[each.light.name] = {
                "lab": each.lab[row].tolist(),
                "largest_delta_e_2000": float(each.largest.delta_e_2000[row]),
                "largest_lab": lab(each.largest.xyz[row], each.light.white).tolist(),
                "outer_delta_e_2000": float(each.largest.outer[row]),
                "lab_range": each.box[row].tolist(),
                "share": float(each.share[row]),
                "outline": each.outline(row).tolist(),
                "covariance": None
                if each.covariance is None
                else each.covariance[row].tolist(),
                "likely": None if likely is None else likely.tolist(),
                "likely_share": LIKELY,
            }
        yield result_object(answers, result) | {"bounds": fields}


def _print_csv(blocks: Iterable[Block]) -> None:
    limits = ["L*_min", "a*_min", "b*_min", "L*_max", "a*_max", "b*_max"]
    columns = [*"rgb", "light", "L*", "a*", "b*", "standard_error", "error_bound"]
    print_csv([*columns, "largest", "outer", *limits, "share"], _csv_rows(blocks))


def _csv_rows(blocks: Iterable[Block]) -> Iterator[list[Any]]:
    for results, bounds in blocks:
        for (row, result), shown in product(enumerate(results), bounds):
            yield [
                *as_lists(result.rgb),
                shown.light.name,
                *shown.lab[row].tolist(),
                result.standard_errors.get(shown.light.name),
                result.error_bounds.get(shown.light.name),
                float(shown.largest.delta_e_2000[row]),
                float(shown.largest.outer[row]),
                *shown.box[row].ravel().tolist(),
                float(shown.share[row]),
            ]


def _print_table(cube: Cube, blocks: Iterable[Block], *, single: bool) -> None:
    from uplift.extras.looks.lab_errors import LIKELY

    for number, (results, found) in enumerate(blocks):
        if single:
            rgb = results[0].rgb
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
            for column, each in enumerate(found):
                code = hex_code(cube, result.rgb) if column == 0 else ""
                error = result.error_bounds.get(each.light.name)
                (_, least_a, least_b), (_, most_a, most_b) = each.box[row].tolist()
                table.add_row(
                    *(code,) * (not single),
                    each.light.name,
                    " ".join(f"{value:.1f}" for value in each.lab[row]),
                    "–" if error is None else f"{error:.2f}",
                    f"{each.largest.delta_e_2000[row]:.2f}",
                    f"{round(least_a)}..{round(most_a)}",
                    f"{round(least_b)}..{round(most_b)}",
                    f"{100 * each.share[row]:.2g}%",
                )
        show(table)
