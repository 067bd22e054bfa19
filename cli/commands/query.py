"""``uplift query``: spectra of colours."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from ..output.query_answers import Answers
from ..output.query_output import WRITERS
from ..params.options import (
    Decorator,
    cube_option,
    encoded_option,
    fill_option,
    force_option,
    format_option,
    input_option,
    input_space_option,
    light_option,
    out_of_gamut_option,
    stacked,
    wavelengths_option,
    xyz_options,
)
from ..params.plots import plot_option
from ..params.query_colours import find_point, read_colours
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


def colour_options() -> Decorator:
    """Argument and options of the colours of a query, and of how they are answered; for `ask`."""
    return stacked(
        click.argument("colour", nargs=-1),
        cube_option(),
        input_option(),
        xyz_options("Colour by XYZ under the cube's illuminant, where white has Y = 1; also outside the cube's space."),
        encoded_option(),
        wavelengths_option(),
        click.option(
            "--mode",
            type=click.Choice(("spectra", "moments", "refined", "nearest")),
            default="spectra",
            show_default=True,
            help="Interpolate spectra (exact), coefficients (fast), coefficients with refinement, or use the nearest "
            "node.",
        ),
        input_space_option("the colours", default="that of the cube"),
        out_of_gamut_option(),
        fill_option(),
    )


def ask(
    colour: tuple[str, ...],
    cube_path: str | None,
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
) -> tuple[Answers, Iterable[list[QueryResult]], bool]:
    """Return answers, their blocks, and whether there is a single colour, from the values of `colour_options`."""
    from uplift.lookup import load

    space = resolve_space(input_space)
    point, single = find_point(colour, input_path, xyz, xy, luminance)
    cube = load(cube_path)
    at = parse_wavelengths(wavelengths)
    answers = Answers(cube, method, at, mode, _read_lights(lights, cube), fill_missing=fill_missing)
    if point is not None:
        return answers, answers.result_of_xyz(point), single
    bounded = method == "error" and input_space is None
    blocks = read_colours(colour, input_path, cube.data.sensor, encoded=encoded, bounded=bounded, space=space)
    return answers, answers.results(blocks), single


@click.command("query", cls=ColourCommand)
@colour_options()
@light_option("Illuminant under which colour and standard error are shown", "none")
@format_option("table", "json", "csv")
@plot_option("--plot", "plot_path", "Plot the spectra")
@force_option()
def command(lights: tuple[str, ...], style: str, plot_path: str | None, force: bool, **colours: Any) -> None:
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

    Standard errors are those of materials like the entries of the cube's atlas. RGB does not identify a material:
    others of the same colour may differ by more, at most as 'uplift bounds' states.

    Lines of files and of standard input are answered in blocks as they come. An error in a later block follows the
    answers to earlier ones.
    """
    from uplift.common.files import check_outputs

    check_outputs((plot_path,), inputs=(colours["cube_path"], colours["input_path"]), force=force)
    answers, results, single = ask(lights=lights, **colours)
    if plot_path is not None:
        from uplift.viz.plots import plot_spectra

        hide_drawing_notes()
        results = list(results)
        plot_spectra(answers.cube, list(chain.from_iterable(results)), plot_path, force=force)
    WRITERS[style](answers.cube, results, single)
    answers.warn()


def _read_lights(names: Sequence[str], cube: Cube) -> list[Light]:
    if not names:
        return []
    from uplift.colorimetry.observer import light

    lights = (light(name, cube.observer, *cube.data.sensor.range) for name in names)
    return list({each.name: each for each in lights}.values())
