"""``uplift bounds``: what reflectances of one colour can do under other lights."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from uplift.common.files import write_text

from .. import also as further
from .. import options
from ..output.answers import as_lists, hex_code
from ..output.bounds import bounds_cells, bounds_fields, bounds_table, print_colours
from ..output.console import (
    json_output,
    print_csv,
    print_json_answers,
    say,
    show,
)
from ..output.query_blocks import json_objects
from ..outputs import check_outputs
from ..queries import Answers, colour_options

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.colour.query import QueryBlock
    from uplift.extras.looks.metamer_bounds import Bounds
    from uplift.lookup.cube import Cube


class Cut(NamedTuple):
    """Bounds of a colour that is also known under further lights, by their names."""

    names: list[str]
    others: Array
    """(L, 3) linear RGB under them."""
    by_light: Sequence[Bounds]
    errors: list[list[float]]
    """Standard error and error bound under each light."""


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
    everyday=("cube_path", "encoded", "also", "lights", "style", "plot_path", "html"),
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
      uplift bounds '#8a2a20' --also A:'#9a3020' --light FL11
      uplift bounds --cube macbeth-32.uplift 0.8 0.2 0.1 --format json

    With --also, the colour in a photograph under another light, they are bounds of the
    reflectances that have both colours, after those of the one.

    The page of --html shows the bounds of one colour and a spectrum for every choice in
    them; it writes the TOML for 'uplift build --look'.
    """,
)
@colour_options
@further.also(
    "COLOUR", further.is_colour, "Colour of the same thing under another light"
)
@options.light("Illuminant under which the bounds are shown", "A FL11 HP1")
@options.table_json_or_csv
@options.plot("Plot the bounds")
@options.page(
    "Write a page on which the colour under each --light is dragged within its "
    "bounds, for a file of looks."
)
@options.force
def command(
    also: Sequence[further.Further],
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
    if also:
        if not answers.single:
            raise click.UsageError("--also needs one colour on the command line.")
        if html is not None or style == "csv":
            raise click.UsageError("--also does not apply to --html and --format csv.")
        _print_cut(answers, also, plot_path, style, force)
        return
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


def _print_cut(
    answers: Answers,
    also: Sequence[further.Further],
    plot_path: str | None,
    style: str,
    force: bool,
) -> None:
    """Print and draw the bounds of a colour, with and without those under further
    lights.
    """
    ((results, whole),) = [_compute(answers, block) for block in answers]
    cut = _cut(answers, results, also)
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_bounds

        plot_bounds(answers.cube, [whole], plot_path, cut=cut.by_light, force=force)
        say(f"{plot_path}: bounds", err=True)
    if style == "json":
        (text,) = _objects(answers, results, whole)
        fields = json_output(_cut_fields(cut))
        print_json_answers([[f"{text[:-1]}, {fields[1:]}"]], single=True)
    else:
        _print_cut_table(answers.cube, results, whole, cut)


def _cut(answers: Answers, results: QueryBlock, also: Sequence[further.Further]) -> Cut:
    """Compute the bounds of a colour that is known under further lights."""
    from uplift.extras.looks.photograph_bounds import bounds_of_photographs
    from uplift.extras.photographs.errors import light_errors

    known = further.photographed_colour(
        answers.cube, answers.source, also, (0.0, 0.0), "light"
    )
    photographs = known.photographs
    others = known.others.reshape(-1, 3)
    by_light = [
        bounds_of_photographs(
            photographs, results.rgb, others.reshape(1, -1), light, SINGLE_DIVISIONS
        )
        for light in answers.lights
    ]
    errors = []
    for bounds in by_light:
        expected = light_errors(photographs, bounds.light)(results.rgb)[0]
        possible = bounds.largest.delta_e_2000[0]
        errors.append(expected.clip(max=possible).tolist())
    names = [photograph.light for photograph in photographs.further]
    return Cut(names, others, by_light, errors)


def _cut_fields(cut: Cut) -> dict[str, Any]:
    """Return the bounds of a colour that is known under further lights as JSON
    values.
    """
    fields = {}
    for bounds, (standard, bound) in zip(cut.by_light, cut.errors, strict=True):
        errors = {"standard_error": standard, "error_bound": bound}
        fields[bounds.light.name] = {**bounds_fields(bounds, 0), **errors}
    return {
        "also": dict(zip(cut.names, cut.others.tolist(), strict=True)),
        "also_reflectance": cut.by_light[0].reflectance[0].tolist(),
        "also_bounds": fields,
    }


def _print_cut_table(
    cube: Cube, results: QueryBlock, whole: Sequence[Bounds], cut: Cut
) -> None:
    """Print two rows for each light: those of the colour, and of all its colours."""
    print_colours(cube, results.rgb[0], cut.names, cut.others)
    (result,) = results
    first = cube.data.sensor.illuminant
    every = ", ".join((first, *cut.names))
    table = bounds_table(("light", "known"))
    for before, after, (_, bound) in zip(whole, cut.by_light, cut.errors, strict=True):
        light = before.light.name
        error = result.error_bounds.get(light)
        table.add_row(light, first, *bounds_cells(before, 0, error))
        table.add_row("", every, *bounds_cells(after, 0, bound))
    show(table)


def _objects(
    answers: Answers, results: QueryBlock, by_light: Sequence[Bounds]
) -> Iterable[str]:
    for row, text in enumerate(json_objects(answers, results)):
        fields = {bounds.light.name: bounds_fields(bounds, row) for bounds in by_light}
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
    for number, (results, by_light) in enumerate(blocks):
        if single:
            print_colours(cube, results.rgb[0], (), results.rgb[:0])
        headings = ("hex",) * (not single) + ("light",)
        table = bounds_table(headings, show_header=number == 0)
        for row, result in enumerate(results):
            code = hex_code(cube, result.rgb)
            for bounds in by_light:
                light = bounds.light.name
                error = result.error_bounds.get(light)
                cells = bounds_cells(bounds, row, error)
                table.add_row(*(code,) * (not single), light, *cells)
                code = ""  # once for all lights
        show(table)
