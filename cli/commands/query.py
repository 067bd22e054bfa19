"""``uplift query``: spectra of colours."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING

import click

from uplift.colorimetry.lights import RELIGHT_LIGHTS

from ..output.light_output import query_lights, treatment, write_lights
from ..output.query_answers import Answers
from ..output.query_output import WRITERS
from ..params.number_types import NUMBER
from ..params.options import (
    cube_option,
    emission_option,
    fill_option,
    force_option,
    format_option,
    input_space_option,
    light_option,
    out_of_gamut_option,
    refuse_for_lights,
    wavelengths_option,
)
from ..params.plots import plot_option
from ..params.query_colours import as_xyz, lights_xyz, read_colours
from ..params.spaces import resolve_space
from ..params.wavelengths import parse_wavelengths
from ..startup import hide_drawing_notes

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Light
    from uplift.lookup import Cube, QueryResult

NEGATIVE_NUMBER = re.compile(r"-\.?\d")


class ColourCommand(click.Command):
    """A command that reads '-0.1' as a number, not as an option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Mark negative numbers by a leading space before parsing."""
        return super().parse_args(ctx, [f" {arg}" if NEGATIVE_NUMBER.match(arg) else arg for arg in args])


@click.command("query", cls=ColourCommand)
@click.argument("colour", nargs=-1)
@cube_option()
@emission_option("The colour is that of a light, of any brightness")
@click.option("--input", "input_path", metavar="FILE", help="CSV of colours, one per line; '-' is standard input.")
@click.option(
    "--xyz",
    type=NUMBER,
    nargs=3,
    metavar="X Y Z",
    help="Colour by XYZ under the cube's illuminant, where white has Y = 1; also outside the cube's space.",
)
@click.option(
    "--xy",
    type=NUMBER,
    nargs=2,
    metavar="X Y",
    help="Colour by chromaticity, with --luminance, as for --xyz.",
)
@click.option("--luminance", type=NUMBER, metavar="Y", help="Luminance of --xy from 0 to 1.")
@click.option("--encoded", is_flag=True, help="Numbers are encoded 8-bit codes from 0 to 255.")
@wavelengths_option()
@click.option(
    "--mode",
    type=click.Choice(("spectra", "moments", "refined", "nearest")),
    default="spectra",
    show_default=True,
    help="Interpolate spectra (exact), coefficients (fast), coefficients with refinement, or use the nearest node.",
)
@input_space_option("the colours", default="that of the cube")
@out_of_gamut_option()
@fill_option()
@light_option("Illuminant under which colour, standard error or --bounds are shown", "none")
@click.option(
    "--bounds",
    "with_bounds",
    is_flag=True,
    help="Bounds of all reflectances of the colour under each --light, by default A, FL11 and HP1.",
)
@format_option("table", "json", "csv")
@plot_option("--plot", "plot_path", "Plot the spectra, or the bounds")
@click.option(
    "--html",
    metavar="FILE",
    help="Write a page on which the colour under each --light is dragged within its bounds, for a file of looks.",
)
@force_option()
def command(
    colour: tuple[str, ...],
    cube_path: str | None,
    is_emission: bool,
    input_path: str | None,
    xyz: tuple[float, float, float] | None,
    xy: tuple[float, float] | None,
    luminance: float | None,
    encoded: bool,
    wavelengths: str | None,
    mode: str,
    input_space: str | None,
    method: str,
    fill_missing: bool,
    lights: tuple[str, ...],
    with_bounds: bool,
    style: str,
    plot_path: str | None,
    html: str | None,
    force: bool,
) -> None:
    """Query the spectrum of a COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    Numbers are linear RGB from 0 to 1 in the cube's space, or in that of --input-space. Hex colours, and numbers with
    --encoded, are encoded by the transfer function of the space.

    \b
    Examples:
      uplift query 0.8 0.2 0.1
      uplift query --cube macbeth-32.uplift '#cc3319' --plot red.png
      uplift query --encoded 204 51 25 --wavelengths 400:700:10 --format json
      uplift query --input colours.csv --format csv > spectra.csv
      uplift query 1.4 0.3 -0.1 --out-of-gamut desaturate
      uplift query --input-space P3-D65 0.2 0.9 0.3 --out-of-gamut desaturate
      uplift query --xyz 0.05 0.2 0.1
      uplift query --xy 0.17 0.7 --luminance 0.15 --format json
      echo 0.5,0.5,0.5 | uplift query - --format json
      uplift query '#cc3319' --cube macbeth-32.uplift --light FL11 --light HP1
      uplift query 30 22 9 --emission
      uplift query '#8a2a20' --bounds --light A --light FL11 --plot bounds.png
      uplift query '#8a2a20' --light A --light FL11 --html red.html

    Standard errors are those of materials like the entries of the cube's atlas. RGB does not identify a material:
    others of the same colour may differ by more. --bounds computes by how much any reflectance can: the largest ΔE00
    from the answer under a light, and the ranges of L*, a* and b*. The page of --html shows the bounds of one colour
    and a spectrum for every choice in them; it writes the TOML for 'uplift build --look'.

    With --emission, colours are lights: linear RGB of any size, negative components included, and the spectrum is a
    power of which 1 at all wavelengths has luminance 1. Colours that no light has are errors, or with --out-of-gamut
    clip the nearest ones towards white.

    Lines of files and of standard input are answered in blocks as they come. An error in a later block follows the
    answers to earlier ones.
    """
    from uplift.common.files import check_outputs
    from uplift.lookup import load

    check_outputs((plot_path, html), inputs=(cube_path, input_path), force=force)
    space = resolve_space(input_space)
    point = as_xyz(xyz, xy, luminance)
    if point is not None and (colour or input_path is not None):
        raise click.UsageError("Give one colour, --input FILE, '-', --xyz or --xy. See 'uplift query --help'.")
    single = point is not None or (bool(colour) and colour != ("-",))
    if is_emission:
        refuse_for_lights("mode", "fill_missing", "lights", "with_bounds", "html")
        from uplift.lights.lookup import load_emission

        table = load_emission(cube_path)
        found = lights_xyz(table, point, colour, input_path, encoded=encoded, space=space)
        lit = query_lights(table, found, parse_wavelengths(wavelengths), treatment(method))
        write_lights(table, lit, style, plot_path, single=single, force=force)
        return
    cube = load(cube_path)
    bounded = method == "error" and input_space is None
    answers = Answers(
        cube,
        method,
        parse_wavelengths(wavelengths),
        mode,
        _read_lights(lights or (RELIGHT_LIGHTS if with_bounds or html else ()), cube),
        fill_missing=fill_missing,
    )
    results: Iterable[list[QueryResult]]
    if point is not None:
        results = answers.result_of_xyz(point)
    else:
        blocks = read_colours(colour, input_path, cube.data.sensor, encoded=encoded, bounded=bounded, space=space)
        results = answers.results(blocks)
    if html is not None and not single:
        raise click.UsageError("--html shows one colour: give it on the command line.")
    if with_bounds or html is not None:
        from ..output.bounds_output import write_bounds

        bounds = ((block, answers.bounds(block, single=single)) for block in results)
        write_bounds(cube, bounds, style, plot_path, html, single=single, force=force)
    else:
        if plot_path is not None:
            from uplift.viz.spectra import plot_spectra

            hide_drawing_notes()
            results = list(results)
            plot_spectra(cube, list(chain.from_iterable(results)), plot_path, force=force)
        WRITERS[style](cube, results, single)
    answers.warn()


def _read_lights(names: Sequence[str], cube: Cube) -> list[Light]:
    if not names:
        return []
    from uplift.colorimetry.observer import light

    lights = (light(name, cube.observer, *cube.data.sensor.range) for name in names)
    return list({each.name: each for each in lights}.values())
