"""``uplift paints mix``: spectral mixtures of paints, dyes, filters and lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError, OutputError
from uplift.common.text import pluralise

from .. import options
from ..inputs import check_range, find_input_space
from ..mixtures import (
    MIXTURE_MAPPING,
    plot_ramp,
    print_mixture,
    print_theories,
)
from ..output.console import say
from ..output.diagnostics import warn
from ..output.progress import progress_bar
from ..outputs import check_outputs
from ..startup import enable_jit_cache
from ..surfaces import SURFACE, stated_surface, surface_options

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.images.converter import RowConverter
    from uplift.extras.paint.optics import Coat
    from uplift.extras.paint.paints import Paints
    from uplift.extras.paint.pigments import Scattering
    from uplift.lookup.cube import Cube

SUMS = ("filter", "light")
"""Kinds that are no coats."""
COAT = ("plate", "over", "plot_path")


@click.command(
    "mix",
    cls=options.Command,
    everyday=(
        "kind",
        "paints_path",
        "thickness",
        "ground",
        "cube_path",
        "files",
        "plot_path",
        "over",
        "output",
    ),
    help="""Mix colours as spectra. A cube converts each colour to a spectrum, and the
    mixture has its illuminant.

    A COLOUR is '#rrggbb', 'r,g,b' in linear RGB, 'white', 'black', or an entry of the
    cube's atlas or of --atlas. 'A/B' is a paint whose layer of thickness 1 has colour A
    on white and colour B on black. Other paints are opaque by default, and --thickness
    is in units of about one scattering event.

    \b
    Examples:
      uplift paints mix --pigment 2:'#005fa0' 1:'#ffd200'
      uplift paints mix blue yellow --cube macbeth-32.uplift --plot ramp.png
      uplift paints mix '#c8342a' --thickness 0.5 --ground '#f0e8d8' --format json
      uplift paints fit swatches.csv -o paints.toml
      uplift paints mix '3:lemon yellow' '1:deep blue' --paints paints.toml
    \f

    \b
    More examples:
      uplift paints mix --dye '#d03060' --refractive-index 1.5 --thickness 2
      uplift paints mix '#ec7' --surface-reflectance .04 --internal-reflectance .6
      uplift paints mix --dye '#d03060' --refractive-index 1.5 --plate transmitted
      uplift paints mix --duntley 2:duntley.csv --thickness 0.5 --ground black
      uplift paints mix --filter 2:'#ff8000' 1:0.5,0.5,0.5
      uplift paints mix --additive '#ff0000' 0.5:'#00ff00'
      uplift paints mix '#c43/#612' --thickness .4 --over painting.exr -o coat.exr
      uplift paints mix --theories '#005fa0' '#ffd200'
    """,
)
@click.argument("words", metavar="[PARTS:]COLOUR...", nargs=-1, required=True)
@click.option(
    "--pigment",
    "kind",
    flag_value="pigment",
    default="pigment",
    help="Mix paints, which absorb and scatter.",
)
@click.option("--dye", "kind", flag_value="dye", help="Mix dyes, which absorb.")
@click.option(
    "--duntley",
    "kind",
    flag_value="duntley",
    help="Mix paints by Duntley's theory. Ingredients are [PARTS:]FILE: tables, over "
    "wavelength, of the constants "
    "K', B', F' of a beam and K, B, F of diffuse light, per unit thickness.",
)
@click.option(
    "--filter",
    "kind",
    flag_value="filter",
    help="Stack filters; PARTS is the thickness.",
)
@click.option(
    "--additive", "kind", flag_value="light", help="Add lights; PARTS is the intensity."
)
@click.option(
    "--paints",
    "paints_path",
    metavar="FILE",
    type=click.Path(),
    help="Measured paints by 'uplift paints fit', whose names are the ingredients. The "
    "surface is theirs unless options state another.",
)
@options.number(
    "--thickness",
    metavar="X",
    help="Thickness of the coat. [default: opaque; dyes, --duntley: 1]",
)
@click.option(
    "--ground", metavar="COLOUR", help="Substrate of the coat. [default: white]"
)
@surface_options("1 leaves out the surface")
@click.option(
    "--plate",
    type=click.Choice(("reflected", "transmitted")),
    help="With --dye: the light that a free plate of the dye reflects, with --ground "
    "behind it, or transmits. --refractive-index is that of the plate.",
)
@options.choice(
    "--scattering",
    *("dispersive", "root", "constant"),
    help="Scattering that is assumed of a paint given by one colour: dispersive is "
    "strongest on the long-wave side of "
    "an absorption, root is √R for a reflectance R, constant is 1.",
)
@options.flag(
    "--theories",
    help="Mix the colours by every model: Kubelka and Munk, Amy, Duntley, dyes, "
    "filters, and heuristics of RGB.",
)
@options.cube()
@options.atlas("Measured spectra whose entries are ingredients")
@options.output_wavelengths
@options.out_of_gamut(
    MIXTURE_MAPPING,
    "which keeps the hue of bright mixtures; ingredients: error",
    "mixtures and pixels",
)
@options.table_or_json
@options.plot("Plot the ramp from the first ingredient to the last")
@click.option(
    "--over", metavar="IMAGE", help="Image to paint over (EXR, PNG, JPEG, TIFF)."
)
@options.output(help="With --over: image to write, as .exr.")
@options.encoding
@options.input_space(
    "the colours and of the image of --over", default="that of the cube"
)
@options.force
def command(
    words: Sequence[str],
    kind: str,
    paints_path: str | None,
    thickness: float | None,
    ground: str | None,
    plate: str | None,
    scattering: str,
    theories: bool,
    cube_path: str | None,
    files: Sequence[str],
    wavelengths: Array | None,
    method: str,
    style: str,
    plot_path: str | None,
    over: str | None,
    output: str | None,
    encoding: str,
    input_space: str | None,
    force: bool,
    **surface: Any,
) -> None:
    import numpy as np

    from uplift.extras.paint.mixture import (
        SpectrumResolver,
        display_mixture,
        read_entries,
        read_recipe,
    )
    from uplift.extras.paint.optics import NO_SURFACE
    from uplift.lookup.cube import load

    _check_kind(kind, plate, theories=theories)
    if output is not None and not output.lower().endswith(".exr"):
        raise OutputError(
            "painted images are OpenEXR files",
            path=output,
            hint="give a file name ending in .exr",
        )
    paints = None
    if paints_path is not None:
        kind = "measured"
        paints = _read_paints(paints_path, thickness)
    check_outputs(plot_path, output, inputs=[word.partition(":")[2] for word in words])
    cube = load(cube_path)
    sensor = cube.data.sensor
    further = np.array([])
    if not theories and over is None:
        further = _output_wavelengths(wavelengths, cube)
        # Paints have the colours of their own sensor, if the cube has its space and
        # light.
        if paints is not None and _setting(sensor) == _setting(paints.sensor):
            sensor = paints.sensor
    # The default is for mixtures: an ingredient outside [0, 1] is a mistake, unless the
    # option is given.
    strict = method if "method" in options.given() else "error"
    resolver = SpectrumResolver(
        cube,
        read_entries(files),
        np.concatenate([sensor.wavelengths, further]),
        None if input_space is None else find_input_space(input_space),
        strict,
    )
    recipe = read_recipe(resolver, words, kind, paints)
    if theories:
        print_theories(recipe, cube, method, style)
        return
    usual = NO_SURFACE if paints is None else paints.surface
    stated = stated_surface(**surface) or usual

    def coat(amounts: Sequence[float] | Array) -> Coat:
        law = _scattering_law(scattering, cube.data.sensor, further)
        components = recipe.components(law, in_plate=plate is not None)
        return components.coat(amounts, thickness, stated)

    if over is not None and output is not None:
        provenance = {
            "kind": recipe.kind,
            "of": list(map(list, zip(recipe.parts, recipe.names, strict=True))),
            "thickness": thickness,
            "surface": vars(stated),
            "scattering": scattering,
        }
        if plate:
            provenance["plate"] = True
        enable_jit_cache()
        from uplift.extras.paint.overpaint import overpainter

        painter = overpainter(
            cube,
            coat(recipe.parts),
            provenance,
            encoding=encoding,
            out_of_gamut=method,
            space=input_space,
        )
        _paint(painter, over, output, force=force)
        return
    if kind in SUMS:
        mixed = recipe.sums()
    elif plate == "transmitted":
        mixed = coat(recipe.amounts).layer.transmittance
    else:
        mixed = coat(recipe.amounts).over(resolver.spectrum(ground or "white"))
    mixture = display_mixture(recipe, cube, sensor, mixed, method)
    if plot_path is not None:
        plot_ramp(mixture, cube, plot_path, force=force)
    complete = wavelengths is not None
    print_mixture(mixture, cube, further, style, complete=complete)


def _check_kind(kind: str, plate: str | None, *, theories: bool) -> None:
    """Raise for options that do not apply to a kind of mixture."""
    given = options.given().keys()
    if len(given & {"over", "output"}) == 1:
        raise click.UsageError("--over IMAGE and --output EXR require each other.")
    if given >= {"over", "plot_path"}:
        raise click.UsageError("--plot shows a mixture and does not apply to --over.")
    if plate is not None and kind != "dye":
        raise click.UsageError("--plate applies to --dye.")
    if plate == "transmitted" and given & {"ground", "over"}:
        raise click.UsageError(
            "--plate transmitted does not apply to --ground and --over."
        )
    if "ground" in given and (kind in SUMS or "over" in given):
        raise click.UsageError(
            "--ground applies to coats of --pigment, --dye or --duntley, without "
            "--over."
        )
    if kind in SUMS and given & {"over", "thickness", *SURFACE}:
        raise OptionError(
            f"{kind}s must not have a thickness, a surface or a ground",
            hint="leave them out; parts of filters are their thickness",
        )
    if "paints_path" in given and (
        kind != "pigment" or given & {"files", "input_space", "scattering", "theories"}
    ):
        raise click.UsageError(
            "--paints mixes measured paints, without --dye, --duntley, --filter, "
            "--additive, --theories, --scattering, --atlas and --input-space."
        )
    if theories and (kind == "duntley" or given & {"thickness", "ground", *COAT}):
        raise click.UsageError(
            "--theories mixes opaque colours, without --duntley, --thickness, "
            "--ground, --plate, --over and --plot."
        )


def _read_paints(path: str, thickness: float | None) -> Paints:
    from uplift.extras.paint.paints import check_unit
    from uplift.extras.paint.paints_file import read_paints

    paints = read_paints(path)
    check_unit(paints, thickness)
    return paints


def _output_wavelengths(wavelengths: Array | None, cube: Cube) -> Array:
    from uplift.lookup.blocks import as_wavelengths

    if wavelengths is not None:
        check_range(wavelengths, cube.wavelengths)
    return as_wavelengths(wavelengths, cube.wavelengths)


def _setting(sensor: Sensor) -> tuple[str, str, str]:
    return sensor.space, sensor.illuminant, sensor.observer


def _scattering_law(name: str, sensor: Sensor, further: Array) -> Scattering:
    from uplift.extras.paint.pigments import CONSTANT, SQUARE_ROOT, dispersive

    laws: dict[str, Scattering] = {"root": SQUARE_ROOT, "constant": CONSTANT}
    return laws.get(name) or dispersive(sensor, further)


def _paint(painter: RowConverter, over: str, output: str, *, force: bool) -> None:
    """Paint a coat over an image."""
    from uplift.extras.texture.conversion import convert

    with progress_bar("rows") as progress:
        painted = convert(painter, over, output, force=force, progress=progress)
    warn(painted.warnings)
    say(f"{output}: {pluralise(painted.counts.pixels, 'pixel')} painted over")
