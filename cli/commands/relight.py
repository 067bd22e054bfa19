"""``uplift relight``: images under other lights, by products of RGB and by spectra."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .. import options
from ..inputs import expand_patterns, find_input_space
from ..output.console import make_table, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lookup import Cube

SAMPLE, SAMPLE_ATLAS = "still-life.png", "macbeth"
PAGE = ".html"
DIM = 32
"""Lattice of the cubes that are built for --atlas."""
MAX_SIDE = 960
"""Pixels of the longer side of an image, as shown."""


@click.command("relight")
@click.argument("images", metavar="[IMAGE]...", nargs=-1)
@options.light("Illuminant", "A FL11 HP1")
@click.option("--cube", "cube_path", metavar="FILE", help="Cube whose spectra are shown as well.")
@options.atlas("Measured spectra; a cube is built from them and shown as well")
@options.encoding("the images")
@options.input_space("the images")
@options.out_of_gamut("clip", "pixels")
@options.output(
    "File to write: a picture if it ends in .png, .svg or .pdf, a page if it ends in .html.", default="relit.png"
)
@options.output_format("table", "json")
@options.force
def command(
    images: tuple[str, ...],
    lights: tuple[str, ...],
    cube_path: str | None,
    files: tuple[str, ...],
    encoding: str,
    input_space: str | None,
    method: str,
    output: str,
    style: str,
    force: bool,
) -> None:
    """Show images under other lights: RGB multiplied by the light, next to spectra.

    Without IMAGE, a sample painted in colours of the ColorChecker is shown, with the ColorChecker as its atlas. Spectra
    come from the packaged cube, which knows no atlas, and from --cube or --atlas. The page has a line to drag between
    two of the methods, and maps of ΔE00. Images are shown with at most 960 pixels per side.

    \b
    Examples:
      uplift relight
      uplift relight wood.png -o wood.html
      uplift relight wood.png still-life.png --atlas paints.csv --light LED-B3 --light HP1 -o both.png
      uplift relight --cube macbeth-32.uplift --format json -o cube.html

    The white of each light is shown as the white of the screen. The table lists ΔE00 from the products of RGB.
    """
    enable_jit_cache()
    from uplift.colorimetry.lights import RELIGHT_LIGHTS
    from uplift.common.errors import OutputError
    from uplift.common.files import check_output, write_text
    from uplift.io.texture.picture import read_picture
    from uplift.report.measures import mean_p95_max
    from uplift.report.relight import RGB_PRODUCT, relight, relit_page, write_relit_sheet
    from uplift.samples import sample_path
    from uplift.viz.figure import SUFFIXES

    if cube_path is not None and files:
        raise click.UsageError("--cube and --atlas are alternatives: give one of the two.")
    suffix = Path(output).suffix.lower()
    if suffix not in (*SUFFIXES, PAGE):
        raise OutputError(
            f"the suffix of relit images must be one of {', '.join((*SUFFIXES, PAGE))}, got '{suffix}'",
            path=output,
            hint="give a file name ending in .png for a picture, or .html for a page",
        )
    paths = expand_patterns(images) or [str(sample_path(SAMPLE))]
    check_output(output, inputs=(*paths, cube_path, *files), force=force)
    if not images and cube_path is None:
        files = files or (SAMPLE_ATLAS,)
    with progress_bar("computing spectra"):
        cubes = _cubes(cube_path, files)
        sensor, space = cubes["without atlas"].data.sensor, find_input_space(input_space)
        relit = []
        for path in paths:
            picture = read_picture(path, sensor, max_side=MAX_SIDE, encoding=encoding, out_of_gamut=method, space=space)
            for warning in picture.warnings:
                warnings.warn(warning, stacklevel=1)
            name, opacity, reduction = Path(path).name, picture.opacity, picture.reduction
            relit.append(
                relight(name, picture.rgb, cubes, lights or RELIGHT_LIGHTS, opacity=opacity, reduction=reduction)
            )
        if suffix == PAGE:
            write_text(relit_page(relit), output, force=force)
        else:
            write_relit_sheet(relit, output, force=force)
    rows = []  # ΔE00 of every method from the products of RGB
    for image in relit:
        for rendering in image.renderings:
            for spectra in image.methods[1:]:
                key = {"image": image.name, "light": rendering.light, "spectra": spectra}
                rows.append(key | mean_p95_max(rendering.difference(RGB_PRODUCT, spectra)))
    if style == "json":
        print_json({"output": output, "differences": rows})
        return
    table = make_table(("image", "light", "spectra"), ("mean ΔE00", "95 %", "largest"))
    for row in rows:
        table.add_row(*(each if isinstance(each, str) else f"{each:.2f}" for each in row.values()))
    show(table)
    names = ", ".join(image.name for image in relit)
    say(f"{output}: {names} under {', '.join(each.light for each in relit[0].renderings)}")


def _cubes(path: str | None, atlases: tuple[str, ...]) -> dict[str, Cube]:
    """Return the packaged cube, and the one of the user, by the names of their methods."""
    from uplift.lookup import load

    cubes = {"without atlas": load()}
    if path is not None:
        cubes[Path(path).name] = load(path)
    if atlases:
        from uplift.pipeline.build import build

        cubes[f"with {', '.join(Path(atlas).stem for atlas in atlases)}"] = build(atlases, dim=DIM)
    return cubes
