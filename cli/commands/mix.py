"""``uplift mix``: spectral mixtures of paints, dyes, filters and lights."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import click

from uplift.common.errors import OutputError, UpliftWarning

from ..ingredients import Ingredient, SpectrumResolver, library_ingredients, make_resolver
from ..inputs import find_input_space, parse_wavelengths
from ..options import (
    NUMBER,
    Whole,
    atlas_option,
    cube_option,
    encoding_option,
    force_option,
    format_option,
    input_space_option,
    out_of_gamut_option,
    plot_option,
    wavelengths_option,
)
from ..output.answers import (
    coordinates,
    describe_coordinates,
    format_rgb,
    hex_code,
    patch,
    print_columns,
    print_fields,
    sparkline,
)
from ..output.console import emit, print_json, say
from ..output.progress import progress_bar
from ..startup import enable_jit_cache
from .query import ColourCommand

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.common.arrays import Array
    from uplift.design.mixing import Medium
    from uplift.design.mixing.pigments import Scattering
    from uplift.lookup import Cube

SCATTERINGS = ("dispersive", "root", "constant")
"""Values of --scattering, the default first."""


@click.command("mix", cls=ColourCommand)
@click.argument("words", metavar="[PARTS:]COLOUR...", nargs=-1, required=True)
@click.option(
    "--pigment", "kind", flag_value="pigment", default="pigment", help="Mix paints, which absorb and scatter. [default]"
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
@cube_option
@atlas_option("Measured spectra whose entries are ingredients")
@wavelengths_option
@out_of_gamut_option("scale", "mixtures and pixels")
@format_option("table", "json")
@plot_option("Plot the ramp from the first ingredient to the last")
@click.option("--steps", type=Whole(2, 1000), default=9, show_default=True, help="Number of swatches on the ramp.")
@click.option("--over", metavar="IMAGE", help="Image to paint over (EXR, PNG, JPEG, TIFF).")
@click.option("-o", "--output", metavar="EXR", help="With --over: image to write.")
@encoding_option("the image of --over")
@input_space_option("the colours and of the image of --over", default="that of the cube")
@force_option
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
    plot_path: str | None,
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

    _check_usage(kind, ground, over, output, plot_path)
    if theories and any(option is not None for option in (thickness, ground, over, plot_path)):
        raise click.UsageError("--theories mixes opaque colours, without --thickness, --ground, --over and --plot.")
    check_outputs((plot_path, output), inputs=(cube_path, over, *files), force=force)
    cube = load(cube_path)
    sensor = cube.data.sensor
    surface = Surface.of_index(refractive_index, incidence)
    space = find_input_space(input_space)
    listed = cube.resolve_wavelengths(parse_wavelengths(wavelengths))
    resolver = make_resolver(cube, files, listed, space)
    ingredients = resolver.ingredients(words)
    if theories:
        _print_theories(cube, ingredients, method, style)
    elif over is not None and output is not None:
        medium = Medium(thickness, surface, _scattering(scattering, sensor))
        recipe = {
            "kind": kind,
            "of": [[one.parts, one.name] for one in ingredients],
            "thickness": thickness,
            "surface": asdict(surface),
            "scattering": scattering,
        }
        _paint_over(cube, ingredients, medium, recipe, over, output, encoding, method, space, force=force)
    else:
        medium = Medium(thickness, surface, _scattering(scattering, sensor, listed))
        mixture = _mix(resolver, kind, ingredients, medium, ground, steps, method)
        if plot_path is not None:
            _plot(cube, mixture, plot_path, force=force)
        PRINTERS[style](cube, mixture)


def _check_usage(kind: str, ground: str | None, over: str | None, output: str | None, plot_path: str | None) -> None:
    from uplift.design.mixing.coats import COATS

    if (over is None) != (output is None):
        raise click.UsageError("--over IMAGE and --output EXR require each other.")
    if ground is not None and (kind not in COATS or over is not None):
        raise click.UsageError("--ground applies to coats of --pigment or --dye, without --over.")
    if over is not None and plot_path is not None:
        raise click.UsageError("--plot shows a mixture and does not apply to --over.")
    if output is not None and not output.lower().endswith(".exr"):
        raise OutputError("painted images are OpenEXR files", path=output, hint="give a file name ending in .exr")


def _scattering(name: str, sensor: Sensor, further: Array | tuple[()] = ()) -> Scattering:
    """Return the scattering of spectra at the wavelengths of a sensor, followed by ``further`` wavelengths in nm."""
    from uplift.design.mixing.pigments import CONSTANT, SQUARE_ROOT, dispersive

    if name == "dispersive":
        return dispersive(sensor, further)
    return SQUARE_ROOT if name == "root" else CONSTANT


def _print_theories(cube: Cube, ingredients: list[Ingredient], method: str, style: str) -> None:
    """Mix the colours of the ingredients by every model of `uplift.design.mixing.mixers`, and print the results."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.design.mixing.theories import mixers

    sensor = cube.data.sensor
    spectra = np.stack([one.spectrum[: len(sensor.wavelengths)] for one in ingredients])
    rgb, parts = np.clip(sensor.rgb(spectra), 0, 1), np.array([one.parts for one in ingredients])
    mixed = {mixer.title: map_to_gamut(mixer.mix(rgb, parts)[None], sensor, method).rgb[0] for mixer in mixers(cube)}
    if style == "json":
        rows = [
            {"theory": title, "rgb": rgb.tolist(), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
            for title, rgb in mixed.items()
        ]
        print_json({"names": [one.name for one in ingredients], "theories": rows}, indent=None)
        return
    for title, rgb in mixed.items():
        swatch = f"{patch(cube, rgb)}  " if sys.stdout.isatty() else ""
        emit(f"{swatch}{hex_code(cube, rgb)}  {format_rgb(rgb)}  {title}")


def _paint_over(
    cube: Cube,
    ingredients: list[Ingredient],
    medium: Medium,
    recipe: Mapping[str, object],
    image: str,
    output: str,
    encoding: str,
    method: str,
    space: ImageSpace | None,
    *,
    force: bool,
) -> None:
    """Paint over an image, write the result with the recipe of the coat, and print the number of pixels."""
    enable_jit_cache()
    from uplift.design.mixing import make_coat, overpainter
    from uplift.io.texture import convert

    mixed = library_ingredients(ingredients, len(cube.data.sensor.wavelengths))
    coat = make_coat(str(recipe["kind"]), mixed, [one.parts for one in ingredients], medium)
    painter = overpainter(cube, coat, recipe, encoding=encoding, out_of_gamut=method, space=space)
    with progress_bar("rows") as progress:
        painted = convert(painter, image, output, force=force, progress=progress)
    for warning in painted.warnings:
        warnings.warn(warning, stacklevel=1)
    say(f"{output}: {painted.counts.pixels:,} pixels painted over")


@dataclass(frozen=True, eq=False)
class Mixture:
    """A mixture and the ramp from its first to its last ingredient.

    Row 0 of ``parts`` (1 + k, n) and of ``rgb`` (1 + k, 3), linear in [0, 1], is the mixture. The other rows are the
    ramp. ``spectrum`` (N,) at ``wavelengths`` (N,) nm is that of the mixture.
    """

    kind: str
    ingredients: list[Ingredient]
    parts: Array
    wavelengths: Array
    spectrum: Array
    rgb: Array

    @property
    def names(self) -> list[str]:
        return [one.name for one in self.ingredients]

    @property
    def recipe(self) -> str:
        """The ingredients as '2 of blue, 1 of yellow'."""
        return ", ".join(f"{one.parts:g} of {one.name}" for one in self.ingredients)


def _mix(
    resolver: SpectrumResolver,
    kind: str,
    ingredients: list[Ingredient],
    medium: Medium,
    ground: str | None,
    steps: int,
    method: str,
) -> Mixture:
    """Mix ingredients, and a ramp of ``steps`` through them. Warns if the mixture lies outside [0, 1]."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.design.mixing.coats import mix, ramp

    sensor = resolver.cube.data.sensor
    parts = np.array([one.parts for one in ingredients])
    amounts = np.concatenate([parts[None], ramp(parts, steps)])
    spectra = mix(kind, library_ingredients(ingredients), amounts, medium, resolver.spectrum(ground or "white"))
    count = len(sensor.wavelengths)
    mapped = map_to_gamut(sensor.rgb(spectra[:, :count]), sensor, method)
    if mapped.outside[0]:
        problem = f"the mixture lies outside [0, 1]: mapped into the gamut ({method})"
        warnings.warn(UpliftWarning(problem), stacklevel=1)
    return Mixture(kind, ingredients, amounts, resolver.wavelengths[count:], spectra[0, count:], mapped.rgb)


def _plot(cube: Cube, mixture: Mixture, path: str, *, force: bool) -> None:
    """Plot swatches of the mixture and of the ramp."""
    from uplift.colorimetry.srgb import to_display_codes
    from uplift.viz.plots import Strip, plot_strips

    codes = to_display_codes(mixture.rgb, cube.data.sensor) / 255
    strips = [Strip(f"{mixture.kind}: {mixture.recipe}", codes[:1])]
    if len(mixture.names) > 1:
        strips.append(Strip(f"from {mixture.names[0]} to {mixture.names[-1]}", codes[1:]))
    plot_strips(strips, path, force=force)


def _print_json(cube: Cube, mixture: Mixture) -> None:
    steps = [
        {"parts": parts.tolist(), "rgb": rgb.tolist(), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
        for parts, rgb in zip(mixture.parts, mixture.rgb, strict=True)
    ]
    fields = {
        "kind": mixture.kind,
        "names": mixture.names,
        **steps[0],
        "wavelengths": mixture.wavelengths.tolist(),
        "spectrum": mixture.spectrum.tolist(),
        "ramp": steps[1:],
    }
    print_json(fields, indent=None)


def _print_table(cube: Cube, mixture: Mixture) -> None:
    rgb, spectrum, wavelengths = mixture.rgb[0], mixture.spectrum, mixture.wavelengths
    fields = {mixture.kind: mixture.recipe, "linear RGB": f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"}
    fields |= describe_coordinates(cube, rgb)
    if len(mixture.names) > 1:
        fields["ramp"] = " ".join(hex_code(cube, step) for step in mixture.rgb[1:])
    shape = spectrum / max(1, spectrum.max())
    fields["spectrum"] = f"{sparkline(shape)}  {wavelengths[0]:g}–{wavelengths[-1]:g} nm"
    ramp = "".join(patch(cube, step, 4) for step in mixture.rgb[1:])
    print_fields(fields, {"linear RGB": patch(cube, rgb), "ramp": ramp})
    emit("")
    print_columns(wavelengths, spectrum)


PRINTERS: dict[str, Callable[[Cube, Mixture], None]] = {"table": _print_table, "json": _print_json}
