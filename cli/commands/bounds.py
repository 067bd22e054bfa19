"""``uplift lab bounds``: what reflectances of one colour can do under other lights."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from uplift.common.files import write_text

from .. import also as further
from .. import options
from ..output.answers import format_rgb, hex_codes, patch
from ..output.console import print_fields, say
from ..output.query import answer_rows
from ..output.table import Table, print_json_rows
from ..outputs import check_outputs
from ..queries import Answers, colour_options

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.colour.query import QueryBlock
    from uplift.extras.looks.metamer_bounds import Bounds
    from uplift.lookup.cube import Cube

Row = Mapping[str, Any]
Block = tuple["QueryBlock", Sequence["Bounds"]]
"""Answers, and their bounds under each light."""
DIVISIONS = 2
"""Density of the directions of bounds: 162 of each of many colours."""
SINGLE_DIVISIONS = 3
"""That of a single colour: 642."""
LAB = ("L*", "a*", "b*")


class Cut(NamedTuple):
    """Bounds of a colour that is also known under further lights, by their names."""

    names: list[str]
    others: Array
    """(L, 3) linear RGB under them."""
    by_light: Sequence[Bounds]
    errors: list[dict[str, Any]]
    """Standard error and error bound under each light."""


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
      uplift lab bounds '#8a2a20'
      uplift lab bounds '#8a2a20' --light A --light FL11 --plot bounds.png
      uplift lab bounds '#8a2a20' --light A --light FL11 --html red.html
      uplift lab bounds '#8a2a20' --also A:'#9a3020' --light FL11
      uplift lab bounds --cube macbeth-32.uplift 0.8 0.2 0.1 --format json

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
    if not answers.single and (also or html is not None):
        option = "--also" if also else "--html"
        raise click.UsageError(f"{option} needs one colour on the command line.")
    if also and (html is not None or style == "csv"):
        raise click.UsageError("--also does not apply to --html and --format csv.")
    blocks: Iterable[Block] = map(partial(_compute, answers), answers)
    cut = None
    if answers.single:
        ((results, by_light),) = blocks
        blocks = [(results, by_light)]
        cut = _cut(answers, results, also) if also else None
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_bounds

        blocks = list(blocks)
        regions = [bounds for _, bounds in blocks]
        inner = cut.by_light if cut else ()
        plot_bounds(answers.cube, regions, plot_path, cut=inner, force=force)
        say(f"{plot_path}: bounds", err=True)
    if html is not None:
        from uplift.extras.report.look_page import page

        write_text(page(answers.cube, by_light), html, force=force)
        say(f"{html}: page to choose a look on", err=True)
    rows = _rows(answers, blocks, cut)
    if style == "json":
        print_json_rows(rows, single=answers.single)
    elif style == "csv":
        Table(_csv_rows(rows)).print_csv()
    elif answers.single:
        _print_colours(answers.cube, results.rgb, cut)
        _print_table(answers.cube, rows, ("light", "known") if cut else ("light",))
    else:
        _print_table(answers.cube, rows, ("hex", "light"))


def _compute(answers: Answers, results: QueryBlock) -> Block:
    from uplift.extras.looks.metamer_bounds import bounds

    divisions = SINGLE_DIVISIONS if answers.single else DIVISIONS
    return results, [
        bounds(answers.cube, results.rgb, light, answers.mode, divisions)
        for light in answers.lights
    ]


def _cut(answers: Answers, results: QueryBlock, also: Sequence[further.Further]) -> Cut:
    """Compute the bounds of a colour that is known under further lights."""
    from uplift.extras.looks.photograph_bounds import bounds_of_photographs
    from uplift.extras.photographs.errors import light_errors

    known = further.photographed_colour(
        answers.cube, answers.source, also, (0.0, 0.0), "light"
    )
    photographs = known.photographs
    others = known.others.reshape(-1, 3)
    by_light = []
    errors = []
    for light in answers.lights:
        bounds = bounds_of_photographs(
            photographs, results.rgb, others.reshape(1, -1), light, SINGLE_DIVISIONS
        )
        expected = light_errors(photographs, bounds.light)(results.rgb)[0]
        standard, bound = expected.clip(max=bounds.largest.delta_e_2000[0]).tolist()
        by_light.append(bounds)
        errors.append({"standard_error": standard, "error_bound": bound})
    names = [photograph.light for photograph in photographs.further]
    return Cut(names, others, by_light, errors)


def _rows(
    answers: Answers, blocks: Iterable[Block], cut: Cut | None
) -> Iterator[dict[str, Any]]:
    """Yield each answer with its bounds by light, as JSON values."""
    for results, by_light in blocks:
        for number, row in enumerate(answer_rows(answers, results)):
            row["bounds"] = {
                bounds.light.name: _fields(bounds, number) for bounds in by_light
            }
            if cut is not None:
                row["also"] = dict(zip(cut.names, cut.others.tolist(), strict=True))
                row["also_reflectance"] = cut.by_light[0].reflectance[0].tolist()
                row["also_bounds"] = {
                    bounds.light.name: _fields(bounds, 0) | errors
                    for bounds, errors in zip(cut.by_light, cut.errors, strict=True)
                }
            yield row


def _fields(bounds: Bounds, row: int) -> dict[str, Any]:
    """Return the bounds of a colour as JSON values."""
    from uplift.colorimetry.delta_e import lab
    from uplift.extras.looks.lab_errors import LIKELY

    largest = bounds.largest
    likely = bounds.likely(row)
    covariance = bounds.covariance
    return {
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


def _csv_rows(rows: Iterable[Row]) -> Iterator[Row]:
    """Yield a row for each colour under each light."""
    for row in rows:
        for light, bounds in row["bounds"].items():
            least, most = bounds["lab_range"]
            yield {
                **dict(zip("rgb", row["rgb"], strict=True)),
                "light": light,
                **dict(zip(LAB, bounds["lab"], strict=True)),
                "standard_error": row["standard_errors"].get(light),
                "error_bound": row["error_bounds"].get(light),
                "largest": bounds["largest_delta_e_2000"],
                "outer": bounds["outer_delta_e_2000"],
                **{f"{name}_min": least[axis] for axis, name in enumerate(LAB)},
                **{f"{name}_max": most[axis] for axis, name in enumerate(LAB)},
                "share": bounds["share"],
            }


def _print_colours(cube: Cube, rgb: Array, cut: Cut | None) -> None:
    """Print the linear RGB (1, 3) under the light of the cube, and under further
    lights.
    """
    colours = {"linear RGB": rgb}
    if cut is not None:
        for name, other in zip(cut.names, cut.others, strict=True):
            colours[f"under {name}"] = other[None]
    fields = {}
    for name, values in colours.items():
        fields[name] = f"{format_rgb(values[0])}  {hex_codes(cube, values)[0]}"
    print_fields(fields, {"linear RGB": patch(cube, rgb[0])})
    say()


def _print_table(cube: Cube, rows: Iterable[Row], texts: Sequence[str]) -> None:
    """Print bounds in a row for each light, or two if the colour is also known under
    further lights.
    """
    import numpy as np

    from uplift.extras.looks.lab_errors import LIKELY

    first = cube.data.sensor.illuminant
    shown: list[Row] = []
    for row in rows:
        (code,) = hex_codes(cube, np.array([row["rgb"]]))
        every = ", ".join((first, *row.get("also", ())))
        for light, bounds in row["bounds"].items():
            bound = row["error_bounds"].get(light)
            start = {"hex": code, "light": light, "known": first}
            shown.append({**start, **_cells(bounds), "error_bound": bound})
            code = ""  # once for all lights
            if "also_bounds" in row:
                start = {"light": "", "known": every}
                shown.append({**start, **_cells(row["also_bounds"][light])})
    headings = {
        **{key: key for key in texts},
        "lab": "L* a* b*",
        "error_bound": f"ΔE {LIKELY:.0%}",
        "largest_delta_e_2000": "ΔE max",
        "a": "a* range",
        "b": "b* range",
        "share": "share",
    }
    formats: dict[str, Any] = {
        "lab": ".1f",
        "a": "{0[0]}..{0[1]}".format,
        "b": "{0[0]}..{0[1]}".format,
        "share": lambda share: f"{100 * share:.2g}%",
    }
    Table(shown, headings, digits=".2f", formats=formats).print_text()


def _cells(bounds: Row) -> dict[str, Any]:
    """Add the ranges of a* and b* to bounds as JSON values."""
    (_, *least), (_, *most) = bounds["lab_range"]
    first, second = zip(map(round, least), map(round, most), strict=True)
    return {**bounds, "a": list(first), "b": list(second)}
