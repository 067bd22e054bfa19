"""``uplift relight``: images under other lights, by products of RGB and by spectra."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..inputs import expand_patterns, find_input_space
from ..options import (
    atlas_option,
    encoding_option,
    force_option,
    format_option,
    input_space_option,
    light_option,
    out_of_gamut_option,
)
from ..output.console import make_table, print_json, say, show
from ..output.progress import spinner
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.lookup import Cube
    from uplift.report.relight import Relit

SAMPLE, SAMPLE_ATLAS = "still-life.png", "macbeth"
PAGE = ".html"
DIM = 32
"""Lattice of the cubes that are built for --atlas."""
MAX_SIDE = 960
"""Pixels of the longer side of an image, as shown."""


@click.command("relight")
@click.argument("images", metavar="[IMAGE]...", nargs=-1)
@light_option("Illuminant", "A FL11 HP1")
@click.option("--cube", "cube_path", metavar="FILE", help="Cube whose spectra are shown as well.")
@atlas_option("Measured spectra; a cube is built from them and shown as well")
@encoding_option("the images")
@input_space_option("the images")
@out_of_gamut_option("clip", "pixels")
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    default="relit.png",
    show_default=True,
    help="File to write: a picture if it ends in .png, .svg or .pdf, a page if it ends in .html.",
)
@format_option("table", "json")
@force_option
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
    from uplift.common.files import check_output
    from uplift.samples import sample_path

    if cube_path is not None and files:
        raise click.UsageError("--cube and --atlas are alternatives: give one of the two.")
    write = _writer(output)
    paths = expand_patterns(images) or [str(sample_path(SAMPLE))]
    check_output(output, inputs=(*paths, cube_path, *files), force=force)
    if not images and cube_path is None:
        files = files or (SAMPLE_ATLAS,)
    with spinner("computing spectra"):
        cubes = _cubes(cube_path, files)
        space = find_input_space(input_space)
        read = partial(_relight, cubes=cubes, encoding=encoding, method=method, space=space)
        relit = [read(path, lights=lights or RELIGHT_LIGHTS) for path in paths]
        write(relit, output, force=force)
    WRITERS[style](relit, output)


def _writer(output: str) -> Callable[..., object]:
    from uplift.common.errors import OutputError
    from uplift.report.relight import write_relit_sheet
    from uplift.report.relight_page import write_relit_page
    from uplift.viz.figure import SUFFIXES

    suffix = Path(output).suffix.lower()
    if suffix == PAGE:
        return write_relit_page
    if suffix in SUFFIXES:
        return write_relit_sheet
    raise OutputError(
        f"the suffix of relit images must be one of {', '.join((*SUFFIXES, PAGE))}, got '{suffix}'",
        code="unknown-suffix",
        path=output,
        hint="give a file name ending in .png for a picture, or .html for a page",
    )


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


def _relight(
    path: str, cubes: dict[str, Cube], lights: tuple[str, ...], encoding: str, method: str, space: ImageSpace | None
) -> Relit:
    from uplift.io.texture.picture import read_picture
    from uplift.report.relight import relight

    sensor = next(iter(cubes.values())).data.sensor
    picture = read_picture(path, sensor, max_side=MAX_SIDE, encoding=encoding, out_of_gamut=method, space=space)
    for warning in picture.warnings:
        warnings.warn(warning, stacklevel=1)
    return relight(Path(path).name, picture.rgb, cubes, lights, opacity=picture.opacity, reduction=picture.reduction)


def _as_table(relit: list[Relit], output: str) -> None:
    table = make_table(("image", "light", "spectra"), ("mean ΔE00", "95 %", "largest"))
    for row in _rows(relit):
        figures = (f"{row[name]:.2f}" for name in ("mean", "p95", "max"))
        table.add_row(row["image"], row["light"], row["spectra"], *figures)
    show(table)
    names = ", ".join(image.name for image in relit)
    say(f"{output}: {names} under {', '.join(each.light for each in relit[0].renderings)}")


def _as_json(relit: list[Relit], output: str) -> None:
    print_json({"output": output, "differences": _rows(relit)})


def _rows(relit: list[Relit]) -> list[dict[str, object]]:
    """Return ΔE00 of every method from the products of RGB."""
    from uplift.report.relight import RGB_PRODUCT

    rows = []
    for image in relit:
        for rendering in image.renderings:
            for method in image.methods[1:]:
                found = rendering.difference(RGB_PRODUCT, method)
                place = {"image": image.name, "light": rendering.light, "spectra": method}
                rows.append({**place, "mean": found.mean, "p95": found.p95, "max": found.max})
    return rows


WRITERS = {"table": _as_table, "json": _as_json}
