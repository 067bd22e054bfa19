"""``uplift mix``: paints, dyes, filters and lights mixed in the spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..output.mixtures import as_json, as_table, draw, mixed_on
from ..params.ingredients import shelf_of
from ..params.options import (
    cube_option,
    encoding_option,
    force_option,
    format_option,
    out_of_gamut_option,
    wavelengths_option,
)
from ..params.wavelengths import parse_wavelengths
from .paint_over import brush, paint
from .query import QueryCommand

if TYPE_CHECKING:
    from uplift.design.mixing.recipes import Medium
    from uplift.design.mixing.surface import Surface

WRITERS = {"table": as_table, "json": as_json}


@click.command("mix", cls=QueryCommand)
@click.argument("words", metavar="[PARTS:]COLOUR...", nargs=-1, required=True)
@click.option(
    "--pigment",
    "kind",
    flag_value="pigment",
    default="pigment",
    help="Paints: they absorb and scatter. [default]",
)
@click.option("--dye", "kind", flag_value="dye", help="Dyes on a ground: they absorb.")
@click.option(
    "--filter", "kind", flag_value="filter", help="Filters one behind the other; PARTS is thickness."
)
@click.option("--light", "kind", flag_value="light", help="Lights on one another; PARTS is strength.")
@click.option(
    "--thickness", type=float, metavar="X", help="Of the coat. [default: hides its ground; dyes: 1]"
)
@click.option("--ground", metavar="COLOUR", help="What a coat lies on. [default: white]")
@click.option(
    "--index",
    type=float,
    default=1.0,
    metavar="N",
    help="Refraction of the vehicle, 1.5 for oil. [default: no surface]",
)
@click.option(
    "--incident",
    type=click.Choice(("perpendicular", "diffuse")),
    default="perpendicular",
    show_default=True,
    help="How light falls on the vehicle that --index is of.",
)
@click.option(
    "--constants",
    type=click.Choice(("two", "one")),
    default="two",
    show_default=True,
    help="Of a paint given by one colour: does it scatter less where it is dark, or alike everywhere?",
)
@cube_option()
@click.option(
    "--atlas", "atlases", multiple=True, metavar="FILE", help="Measured spectra to name; may be repeated."
)
@wavelengths_option()
@out_of_gamut_option("scale", "mixtures and pixels")
@format_option(*WRITERS)
@click.option("--swatches", metavar="PNG", help="Draw the way from the first to the last.")
@click.option(
    "--steps", type=click.IntRange(2, 1000), default=9, show_default=True, help="Swatches on that way."
)
@click.option("--over", metavar="IMAGE", help="Lay the coat over a painting (EXR, PNG, JPEG, TIFF).")
@click.option("-o", "--output", metavar="EXR", help="With --over: the painted image.")
@encoding_option("the image's colours are")
@force_option()
def command(
    words: tuple[str, ...],
    kind: str,
    thickness: float | None,
    ground: str | None,
    index: float,
    incident: str,
    constants: str,
    cube_path: str | None,
    atlases: tuple[str, ...],
    wavelengths: str | None,
    way: str,
    style: str,
    swatches: str | None,
    steps: int,
    over: str | None,
    output: str | None,
    encoding: str,
    force: bool,
) -> None:
    """Mix colours in the spectrum: each is uplifted by a cube, and what comes of them is seen under its light.

    A COLOUR is '#rrggbb', 'r,g,b' in linear RGB, 'white', 'black', or an entry of the cube's atlas or of --atlas.
    'A/B' is a paint that, one unit thick, is A on white and B on black; other paints hide, and --thickness counts
    in units in which they scatter about once.

    \b
    Examples:
      uplift mix --pigment 2:'#005fa0' 1:'#ffd200'
      uplift mix 1:blue 1:yellow --cube macbeth-32.uplift --swatches green.png
      uplift mix '#c8342a' --thickness 0.5 --ground '#f0e8d8' --format json
      uplift mix --dye 1:'#d03060' 3:'#f0c000' --index 1.5 --thickness 2
      uplift mix --filter 2:'#ff8000' 1:0.5,0.5,0.5
      uplift mix --light '#ff0000' 0.5:'#00ff00'
      uplift mix '#c8342a/#401008' --thickness 0.4 --over painting.exr -o painted.exr
    """
    from uplift.common.files import check_output
    from uplift.design.mixing.surface import INCIDENT
    from uplift.lookup import load

    _check_usage(kind, ground, over, output, swatches)
    for path in filter(None, (swatches, output)):
        check_output(path, force=force)
    cube = load(cube_path)
    medium = _medium(thickness, INCIDENT[incident](index), constants)
    asked = cube.wavelengths(parse_wavelengths(wavelengths))
    shelf = shelf_of(cube, atlases, asked)
    ingredients = shelf.ingredients(words)
    if over is not None and output is not None:
        paint(brush(cube, kind, ingredients, medium, encoding, way), over, output, force=force)
        return
    mixture = mixed_on(shelf, kind, ingredients, medium, ground, steps, way)
    if swatches is not None:
        draw(cube, mixture, swatches, force=force)
    WRITERS[style](cube, mixture)


def _check_usage(
    kind: str, ground: str | None, over: str | None, output: str | None, swatches: str | None
) -> None:
    from uplift.common.errors import OutputError
    from uplift.design.mixing.recipes import COATS

    if (over is None) != (output is None):
        raise click.UsageError("--over IMAGE and --output EXR go together.")
    if ground is not None and (kind not in COATS or over is not None):
        raise click.UsageError("--ground is what a coat of --pigment or --dye lies on, in place of --over.")
    if over is not None and swatches is not None:
        raise click.UsageError("--swatches shows a mixture by itself, without --over.")
    if output is not None and not output.lower().endswith(".exr"):
        raise OutputError("painted images are OpenEXR", path=output, hint="name the file .exr")


def _medium(thickness: float | None, surface: Surface, constants: str) -> Medium:
    from uplift.design.mixing.recipes import Medium

    return Medium(thickness, surface) if constants == "two" else Medium(thickness, surface, grading=0.0)
