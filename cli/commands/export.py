"""``uplift export``: write a cube in formats of other tools."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..completion import complete_cube
from ..options import Whole, fill_option, force_option
from ..output.console import say
from ..output.progress import spinner
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.cube import CubeData

PROGRAMS = {"c": ".h", "cuda": ".cuh", "glsl": ".glsl", "hlsl": ".hlsl"}
SUFFIXES = {"coeff": ".coeff", **PROGRAMS, "npz": ".npz", "csv": ".csv", "html": ".html"}


@click.command("export")
@click.argument("cube", metavar="CUBE", shell_complete=complete_cube)
@click.option(
    "-o",
    "--output",
    "out",
    metavar="FILE",
    type=click.Path(),
    help="File to write. [default: CUBE's name in the current folder]",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(tuple(SUFFIXES)),
    help="Format to write. [default: by the suffix of --output]",
)
@click.option("--res", type=Whole(), help="Resolution of a coeff table along each axis. [default: 64]")
@click.option(
    "--mode",
    type=click.Choice(("spectra", "moments")),
    help="What programs interpolate: spectra, with exact colours, or coefficients. [default: spectra]",
)
@click.option(
    "--table",
    type=click.Choice(("header", "file")),
    help="Where the table of a program is. [default: header for c, else file]",
)
@fill_option
@force_option
def command(
    cube: str,
    out: str | None,
    style: str | None,
    res: int | None,
    mode: str | None,
    table: str | None,
    fill_missing: bool,
    force: bool,
) -> None:
    """Write a cube in a format that other tools read.

    \b
    c, cuda, glsl, hlsl
           program that looks up colours
    coeff  table of rgb2spec, for Mitsuba and colour-science
    html   page that relights images in a browser
    npz    all arrays of the cube, for numpy
    csv    one line per node

    Names in a program start with the file's. A C header, also valid C++, contains the table, or loads it from a file
    of numbers. Programs in other languages come with a second file, which they explain. A coeff table stores sigmoid
    spectra of the cube's colours: three coefficients cannot represent the atlas.

    \b
    Examples:
      uplift export macbeth-32.uplift -o macbeth-32.npz
      uplift export macbeth-32.uplift -o srgb.coeff
      uplift export macbeth-32.uplift -o cube.h
      uplift export macbeth-32.uplift -o filed.h --table file
      uplift export macbeth-32.uplift -o moments.glsl --mode moments
      uplift export macbeth-32.uplift --format csv
    """
    style = style or _format_of(out)
    if res is not None and style != "coeff":
        raise click.UsageError("--res applies to --format coeff only: other formats keep the nodes of the cube.")
    if mode is not None and style not in PROGRAMS:
        raise click.UsageError("--mode applies to programs only: other formats do not interpolate.")
    if table is not None and style not in PROGRAMS:
        raise click.UsageError("--table applies to programs only.")
    out = out or Path(cube).stem + SUFFIXES[style]
    from uplift.common.files import check_output
    from uplift.lookup import load

    path = check_output(out, inputs=[cube], force=force)
    options = {"res": res, "mode": mode, "form": table, "style": style if style in PROGRAMS else None}
    options = {key: value for key, value in options.items() if value is not None}
    loaded = load(cube).fill_missing() if fill_missing else load(cube)
    say(f"{path}: {WRITERS[style](loaded.data, path, force=force, **options)}")


def _format_of(out: str | None) -> str:
    """Return the format that the suffix of the output stands for."""
    for name, suffix in SUFFIXES.items():
        if out is not None and Path(out).suffix.lower() == suffix:
            return name
    raise click.UsageError(f"Give --format, or --output ending in {', '.join(SUFFIXES.values())}.")


def _coeff(data: CubeData, path: Path, **options: Any) -> str:
    enable_jit_cache()
    from uplift.io.export import write_coeff

    with spinner("fitting sigmoids"):
        worst = write_coeff(data, path, **options)
    return f"rgb2spec table, largest RGB error {worst:.1e}"


def _program(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_program

    written = write_program(data, path, **options)
    size = sum(each.stat().st_size for each in written) / 1e6
    tables = "".join(f", table in {each}" for each in written[1:])
    return f"{data.lattice.size} nodes, {len(data.atlas.names)} atlas entries, {size:.1f} MB{tables}"


def _npz(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_npz

    return f"{write_npz(data, path, **options)} arrays"


def _csv(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_csv

    return f"{write_csv(data, path, **options)} nodes"


def _html(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.report.live_page import write_page

    return f"page, {write_page(data, path, **options) / 1e6:.1f} MB"


WRITERS: dict[str, Callable[..., str]] = {
    **dict.fromkeys(PROGRAMS, _program),
    "coeff": _coeff,
    "npz": _npz,
    "csv": _csv,
    "html": _html,
}
