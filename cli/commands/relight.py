"""``uplift relight``: images under other lights, by products of RGB and by spectra."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import UpliftWarning
from uplift.common.text import pluralise
from uplift.extras.images.sequences import expand_patterns

from .. import options
from ..inputs import read_pictures
from ..output.console import paragraph, print_json
from ..output.diagnostics import warn
from ..output.notes import collect_notes, print_notes
from ..output.progress import progress_bar
from ..output.table import Table, print_result
from ..outputs import check_outputs
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.images.converter import Converter
    from uplift.extras.images.picture import Picture
    from uplift.extras.relight.relight import Relit
    from uplift.lookup.cube import Cube

SAMPLE = "still-life.png"
SAMPLE_ATLAS = "macbeth"
PAGE = ".html"
IMAGE = ".exr"
SPECTRAL = "spectral"
"""Method of the packaged cube, which knows no atlas."""
DIM = 32
"""Lattice of the cubes that are built for --atlas."""
HEADINGS = {
    "image": "image",
    "light": "light",
    "spectra": "spectra",
    "mean": "mean ΔE00",
    "p95": "95 %",
    "max": "largest",
}


def _check_output(path: str) -> str:
    from uplift.common.errors import OutputError
    from uplift.extras.pages.figure import SUFFIXES, check_suffix

    suffixes = (*SUFFIXES, PAGE, IMAGE)
    suffix = Path(path).suffix.lower()
    if suffix not in suffixes:
        problem = (
            f"the suffix of relit images must be one of {', '.join(suffixes)}, got "
            f"'{suffix}'"
        )
        hint = (
            "give a file name ending in .png for a figure, .html for a page, or .exr "
            "for the image itself"
        )
        raise OutputError(problem, path=path, hint=hint)
    if suffix in SUFFIXES:
        check_suffix(path)
    return path


@click.command(
    "relight",
    help="""Show images under other lights: RGB multiplied by the light, next to
    spectra.

    Without IMAGE, a sample painted in colours of the ColorChecker is shown, with the
    ColorChecker as its atlas. Spectra come from the packaged cube, which knows no atlas
    ('spectral'), and from --cube or --atlas; from --cube alone if it has another RGB
    space, illuminant or observer. The page has a line to drag between two of the
    methods or the original, and maps of ΔE00. Figures and pages show images with at
    most 960 pixels per side.

    With -o relit.exr, one image is written at full size, linear and in its own RGB
    space, by the spectra of --cube or --atlas if there is one. R, G and B are the
    colours under the first light; each further light is a layer of its name, such as
    FL11.R, FL11.G and FL11.B. Alpha and other channels are copied.

    \b
    Examples:
      uplift relight
      uplift relight wood.png -o wood.html
      uplift relight wood.png --atlas paints.csv --light led --light HP1 -o my.png
      uplift relight --cube macbeth-32.uplift --format json -o cube.html
      uplift relight painting.exr --light 3200K --light lamp.spd -o relit.exr

    Eye and camera adapt to lights that look white, so their white becomes the white of
    the screen. The eye does not adapt to a sodium lamp: such lights keep their tint.
    --adapt or --no-adapt shows all lights alike, and pages have a switch. In an .exr
    file, whites are white unless --no-adapt is given. The table lists ΔE00 from the
    products of RGB, relative to the white of the light.""",
)
@click.argument("images", metavar="[IMAGE]...", nargs=-1)
@options.light("Illuminant", "A FL11 HP1")
@options.cube(" whose spectra are shown as well.")
@options.atlas("Measured spectra; a cube is built from them and shown as well")
@options.adapt(
    "adapt, but tinted in pictures under lights too coloured to look white, such as HP1"
)
@options.pixels()
@options.output(
    help="File to write: a figure if it ends in .png, .svg or .pdf, a page if in "
    ".html, the image itself if in .exr.",
    default="relit.png",
    type=options.OutputFile(_check_output),
)
@options.table_or_json
@options.force
def command(
    images: Sequence[str],
    lights: Sequence[Illuminant],
    cube_path: str | None,
    files: Sequence[str],
    output: str,
    style: str,
    adapt: bool | None,
    force: bool,
    **reading: Any,
) -> None:
    enable_jit_cache()
    from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
    from uplift.lookup.cube import load
    from uplift.samples import sample_path

    if cube_path is not None and files:
        raise click.UsageError(
            "--cube and --atlas are alternatives: give one of the two."
        )
    is_image = Path(output).suffix.lower() == IMAGE
    paths = expand_patterns(images) or [str(sample_path(SAMPLE))]
    if is_image and len(paths) > 1:
        raise click.UsageError(
            "An .exr file holds one image: relight images one by one."
        )
    check_outputs(output, inputs=paths)
    atlases = files
    if not images and cube_path is None:
        atlases = files or (SAMPLE_ATLAS,)
    pictures = []
    if not is_image:
        pictures = read_pictures(paths, load(cube_path).data.sensor, **reading)
    with progress_bar("computing spectra"):
        own, notes = _cube_of_user(cube_path, atlases)
    lights = lights or RELIGHT_LIGHTS
    if is_image:
        converter = _relighter(own or load(), lights, adapt=adapt, **reading)
        _write_image(converter, paths[0], output, style, force=force)
    else:
        stems = [Path(path).stem for path in atlases or [cube_path or ""]]
        cubes = _shown_cubes(own, f"{SPECTRAL} with {', '.join(stems)}")
        relit = _relight_all(paths, pictures, cubes, lights)
        _write_pictures(relit, output, adapt=adapt, force=force)
        _print_differences(relit, output, style)
    if own is not None and files:
        print_notes(own, notes, err=style == "json")


def _relighter(
    cube: Cube, lights: Sequence[Illuminant], *, adapt: bool | None, **reading: Any
) -> Converter:
    from uplift.extras.relight.relighter import prepare_relighter

    whitens = adapt is not False
    cores = os.cpu_count() or 1
    return prepare_relighter(cube, lights, adapt=whitens, threads=cores, **reading)


def _write_image(
    converter: Converter, path: str, output: str, style: str, *, force: bool
) -> None:
    """Relight an image at full size."""
    from uplift.extras.texture.conversion import convert

    with progress_bar("computing spectra") as progress:
        conversion = convert(converter, path, output, force=force, progress=progress)
    warn(conversion.warnings)
    shown = json.loads(converter.header["uplift.texture"])["lights"]
    count = conversion.counts.pixels
    if style == "json":
        print_json({"output": output, "lights": shown, "pixels": count})
    else:
        facts = f"{', '.join(shown)}, {pluralise(count, 'pixel')}"
        paragraph(f"{output}: {Path(path).name} under {facts}")


def _shown_cubes(own: Cube | None, name: str) -> dict[str, Cube]:
    """Return the packaged cube, and the user's by its name if there is one, which
    stands alone if it has other settings.
    """
    from uplift.lookup.cube import load

    packaged = load()
    if own is None:
        return {SPECTRAL: packaged}
    is_alike = _setting(own) == _setting(packaged)
    return {SPECTRAL: packaged, name: own} if is_alike else {name: own}


def _setting(cube: Cube) -> tuple[str, str, str]:
    """Return what cubes that are compared must have in common."""
    sensor = cube.data.sensor
    return sensor.space, sensor.illuminant, sensor.observer


def _relight_all(
    paths: Sequence[str],
    pictures: Sequence[Picture],
    cubes: dict[str, Cube],
    lights: Sequence[Illuminant],
) -> list[Relit]:
    from uplift.extras.relight.relight import relight

    with progress_bar("computing spectra"):
        return [
            relight(
                Path(path).name,
                picture.rgb,
                cubes,
                lights,
                opacity=picture.opacity,
                visible=picture.visible,
                reduction=picture.reduction,
            )
            for path, picture in zip(paths, pictures, strict=True)
        ]


def _write_pictures(
    relit: Sequence[Relit], output: str, *, adapt: bool | None, force: bool
) -> None:
    """Write a figure or page."""
    from uplift.common.files import write_text
    from uplift.extras.relight.relight import relit_page, write_relit_sheet

    if Path(output).suffix.lower() == PAGE:
        write_text(relit_page(relit, adapt=adapt), output, force=force)
    else:
        write_relit_sheet(relit, output, adapt=adapt, force=force)


def _print_differences(relit: Sequence[Relit], output: str, style: str) -> None:
    """Print ΔE00 of every method from the products of RGB."""
    from uplift.extras.relight.relight import RGB_PRODUCT

    rows = []
    for image in relit:
        for rendering, spectra in product(image.renderings, image.methods[1:]):
            row = {"image": image.name, "light": rendering.light, "spectra": spectra}
            rows.append(row | rendering.errors((RGB_PRODUCT, spectra)))
    table = Table(rows, HEADINGS, digits=".2f")
    print_result(style, {"output": output, "differences": rows}, table)
    if style != "json":
        names = ", ".join(image.name for image in relit)
        lights = ", ".join(rendering.light for rendering in relit[0].renderings)
        paragraph(f"{output}: {names} under {lights}")


def _cube_of_user(
    path: str | None, atlases: Sequence[str]
) -> tuple[Cube | None, list[UpliftWarning]]:
    """Load the cube of a file, or build that of atlases; None without either."""
    from uplift.lookup.cube import load

    if atlases:
        from uplift.pipeline.build import build

        return collect_notes(partial(build, atlases, dim=DIM))
    return None if path is None else load(path), []
