"""``uplift mix``: spectral mixtures of paints, dyes, filters and lights."""

from __future__ import annotations

import click

from ..output.mixtures import as_json, as_table, make_mixture, plot
from ..output.paint_over import make_brush, paint
from ..output.theories import print_theories
from ..params.ingredients import make_resolver
from ..params.number_types import NUMBER, Whole
from ..params.options import (
    atlas_option,
    cube_option,
    encoding_option,
    force_option,
    format_option,
    input_space_option,
    out_of_gamut_option,
    wavelengths_option,
)
from ..params.plots import plot_option
from ..params.scattering import SCATTERINGS, make_scattering
from ..params.spaces import resolve_space
from ..params.wavelengths import parse_wavelengths
from .query import ColourCommand

WRITERS = {"table": as_table, "json": as_json}


@click.command("mix", cls=ColourCommand)
@click.argument("words", metavar="[PARTS:]COLOUR...", nargs=-1, required=True)
@click.option(
    "--pigment",
    "kind",
    flag_value="pigment",
    default="pigment",
    help="Mix paints, which absorb and scatter. [default]",
)
@click.option("--dye", "kind", flag_value="dye", help="Mix dyes, which absorb.")
@click.option("--filter", "kind", flag_value="filter", help="Stack filters; PARTS is the thickness.")
@click.option("--additive", "kind", flag_value="light", help="Add lights; PARTS is the intensity.")
@click.option("--thickness", type=NUMBER, metavar="X", help="Thickness of the coat. [default: opaque; dyes: 1]")
@click.option("--ground", metavar="COLOUR", help="Substrate of the coat. [default: white]")
@click.option(
    "--refractive-index",
    type=NUMBER,
    default=1.0,
    metavar="N",
    help="Refractive index of the binder, 1.5 for oil. [default: no surface]",
)
@click.option(
    "--incidence",
    type=click.Choice(("perpendicular", "diffuse")),
    default="perpendicular",
    show_default=True,
    help="Incidence of light on the surface given by --refractive-index.",
)
@click.option(
    "--scattering",
    type=click.Choice(SCATTERINGS),
    default=SCATTERINGS[0],
    show_default=True,
    help="Scattering that is assumed of a paint given by one colour: dispersive is strongest on the long-wave side of "
    "an absorption, root is √R for a reflectance R, constant is 1.",
)
@click.option(
    "--theories",
    is_flag=True,
    help="Mix the colours by every model: Kubelka and Munk, Amy, Duntley, dyes, filters, and heuristics of RGB.",
)
@cube_option()
@atlas_option("Measured spectra whose entries are ingredients")
@wavelengths_option()
@out_of_gamut_option("scale", "mixtures and pixels")
@format_option(*WRITERS)
@plot_option("--plot", "swatches", "Plot the ramp from the first ingredient to the last")
@click.option(
    "--steps",
    type=Whole(2, 1000),
    default=9,
    show_default=True,
    help="Number of swatches on the ramp.",
)
@click.option("--over", metavar="IMAGE", help="Image to paint over (EXR, PNG, JPEG, TIFF).")
@click.option("-o", "--output", metavar="EXR", help="With --over: image to write.")
@encoding_option("the image of --over")
@input_space_option("the colours and of the image of --over", default="that of the cube")
@force_option()
def command(
    words: tuple[str, ...],
    kind: str,
    thickness: float | None,
    ground: str | None,
    refractive_index: float,
    incidence: str,
    scattering: str,
    theories: bool,
    cube_path: str | None,
    files: tuple[str, ...],
    wavelengths: str | None,
    method: str,
    style: str,
    swatches: str | None,
    steps: int,
    over: str | None,
    output: str | None,
    encoding: str,
    input_space: str | None,
    force: bool,
) -> None:
    """Mix colours as spectra. A cube converts each colour to a spectrum, and the mixture has its illuminant.

    A COLOUR is '#rrggbb', 'r,g,b' in linear RGB, 'white', 'black', or an entry of the cube's atlas or of --atlas.
    'A/B' is a paint whose layer of thickness 1 has colour A on white and colour B on black. Other paints are opaque by
    default, and --thickness is in units of about one scattering event.

    \b
    Examples:
      uplift mix --pigment 2:'#005fa0' 1:'#ffd200'
      uplift mix blue yellow --cube macbeth-32.uplift --plot ramp.png
      uplift mix '#c8342a' --thickness 0.5 --ground '#f0e8d8' --format json
      uplift mix --dye 1:'#d03060' 3:'#f0c000' --refractive-index 1.5 --thickness 2
      uplift mix --filter 2:'#ff8000' 1:0.5,0.5,0.5
      uplift mix --additive '#ff0000' 0.5:'#00ff00'
      uplift mix '#c8342a/#601810' --thickness 0.4 --over painting.exr -o glazed.exr
      uplift mix --theories '#005fa0' '#ffd200'
    """
    from uplift.common.files import check_outputs
    from uplift.design.mixing import Medium, Surface
    from uplift.lookup import load

    _check_usage(kind, ground, over, output, swatches)
    if theories and any(option is not None for option in (thickness, ground, over, swatches)):
        raise click.UsageError("--theories mixes opaque colours, without --thickness, --ground, --over and --plot.")
    check_outputs((swatches, output), inputs=(cube_path, over, *files), force=force)
    cube = load(cube_path)
    surface = Surface.of_index(refractive_index, incidence)
    space = resolve_space(input_space)
    listed = cube.resolve_wavelengths(parse_wavelengths(wavelengths))
    resolver = make_resolver(cube, files, listed, space)
    ingredients = resolver.ingredients(words)
    if theories:
        print_theories(cube, ingredients, method, style)
        return
    sensor = cube.data.sensor
    if over is not None and output is not None:
        medium = Medium(thickness, surface, make_scattering(scattering, sensor))
        brush = make_brush(cube, kind, ingredients, medium, scattering, encoding, method, space)
        paint(brush, over, output, force=force)
        return
    medium = Medium(thickness, surface, make_scattering(scattering, sensor, listed))
    mixture = make_mixture(resolver, kind, ingredients, medium, ground, steps, method)
    if swatches is not None:
        plot(cube, mixture, swatches, force=force)
    WRITERS[style](cube, mixture)


def _check_usage(kind: str, ground: str | None, over: str | None, output: str | None, swatches: str | None) -> None:
    from uplift.common.errors import OutputError
    from uplift.design.mixing.coats import COATS

    if (over is None) != (output is None):
        raise click.UsageError("--over IMAGE and --output EXR require each other.")
    if ground is not None and (kind not in COATS or over is not None):
        raise click.UsageError("--ground applies to coats of --pigment or --dye, without --over.")
    if over is not None and swatches is not None:
        raise click.UsageError("--plot shows a mixture and does not apply to --over.")
    if output is not None and not output.lower().endswith(".exr"):
        raise OutputError(
            "painted images are OpenEXR files",
            code="unknown-suffix",
            path=output,
            hint="give a file name ending in .exr",
        )
