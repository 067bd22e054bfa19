"""``uplift export``: write a cube in formats of other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise, round_up

from .. import options
from ..output.console import say
from ..output.progress import progress_bar
from ..outputs import stated_inputs

if TYPE_CHECKING:
    from uplift.cube import CubeData
    from uplift.extras.export import TableError
    from uplift.lookup import Cube

PROGRAMS = {"c": ".h", "cuda": ".cuh", "glsl": ".glsl", "hlsl": ".hlsl"}
LUTS = {"cube": ".cube", "clf": ".clf"}
SIGMOIDS = {
    "coeff": ".coeff",
    "luisa": ".cpp",
    "pbrt": ".cpp",
}  # of one suffix the last is the default
SUFFIXES = {
    **SIGMOIDS,
    **PROGRAMS,
    **LUTS,
    "film": ".npy",
    "fourier": ".png",
    "npz": ".npz",
    "csv": ".csv",
    "html": ".html",
}
APPLIES = {
    "res": ("coeff", *LUTS, "film", "fourier"),
    "light": (*LUTS, "film"),
    "adapt": tuple(LUTS),
    "mode": tuple(PROGRAMS),
    "table": tuple(PROGRAMS),
}
"""Formats by the options that apply to them alone."""


@click.command(
    "export",
    help="""Write a cube in a format that other tools read.

    \b
    c, cuda, glsl, hlsl
           program that looks up colours
    coeff  table of rgb2spec, for Mitsuba and colour-science
    pbrt, luisa
           the same as source in C++, for pbrt-v4 and LuisaRender
    cube, clf
           table of the colours under --light, for grading and compositing
    fourier
           table from sRGB to three numbers for textures of 8 bits, and shader
    film   table of a spectrum per chromaticity, for film simulation;
           with --light, as light that reaches the film
    html   page that relights images in a browser
    npz    all arrays of the cube, for numpy
    csv    one line per node

    Names in a program start with the file's. A C header, also valid C++, contains the
    table, or loads it from a file of numbers. Programs in other languages come with a
    second file, which they explain. The tables of coeff, pbrt and luisa store sigmoid
    spectra of the cube's colours: three coefficients cannot represent the atlas.

    \b
    Examples:
      uplift export macbeth-32.uplift -o macbeth-32.npz
      uplift export macbeth-32.uplift -o srgb.coeff
      uplift export macbeth-32.uplift -o rgbspectrum_srgb.cpp
      uplift export macbeth-32.uplift -o cube.h
      uplift export macbeth-32.uplift -o filed.h --table file
      uplift export macbeth-32.uplift -o moments.glsl --mode moments
      uplift export macbeth-32.uplift -o sodium.cube --light HP1
      uplift build --coefficients 3 --warp colour --dim 33 -o three.uplift
      uplift export three.uplift -o fourier.png
      uplift export macbeth-32.uplift -o film.npy
      uplift export macbeth-32.uplift --format csv
    """,
)
@options.cube_argument
@options.output(help="File to write. [default: CUBE's name in the current folder]")
@click.option(
    "--format",
    "style",
    type=click.Choice(tuple(SUFFIXES)),
    metavar="FORMAT",
    help="Format to write. [default: by the suffix of --output]",
)
@click.option(
    "--res",
    type=options.WHOLE,
    help=(
        "Nodes of a table along each axis. [default: coeff 64, cube, clf and fourier "
        "33, film 192]"
    ),
)
@click.option(
    "--light",
    metavar="NAME|FILE",
    type=options.LIGHT,
    shell_complete=options.complete_light,
    help="Illuminant of a cube, clf or film table, or the file of a measured lamp.",
)
@options.adapt()
@click.option(
    "--mode",
    type=click.Choice(("spectra", "moments")),
    help=(
        "What programs interpolate: spectra, with exact colours, or coefficients. "
        "[default: spectra]"
    ),
)
@options.table
@options.fill
@options.force
def command(
    cube: str,
    output: str | None,
    style: str | None,
    fill_missing: bool,
    force: bool,
    **given: Any,
) -> None:
    suffix = "" if output is None else Path(output).suffix.lower()
    style = style or {SUFFIXES[name]: name for name in SUFFIXES}.get(
        ".cuh" if suffix == ".cu" else suffix
    )
    if style is None:
        raise click.UsageError(
            "Give --format, or --output ending in "
            f"{', '.join(dict.fromkeys(SUFFIXES.values()))}."
        )
    settings = {name: value for name, value in given.items() if value is not None}
    for name in settings:
        if style not in APPLIES[name]:
            raise click.UsageError(
                f"--{name} applies to {', '.join(APPLIES[name])} only."
            )
    if style in LUTS and "light" not in settings:
        raise click.UsageError(
            "A cube or clf table shows the colours under a light: give --light, such "
            "as HP1."
        )
    from uplift.common.files import check_output, check_outputs
    from uplift.extras.export import check_form, output_files
    from uplift.lookup import load

    form = check_form(style, settings.get("table")) if style in PROGRAMS else style
    files = output_files(output or Path(cube).stem + SUFFIXES[style], form)
    inputs = stated_inputs()
    path = check_output(files[0], inputs=inputs, force=force)
    check_outputs(
        files, inputs=inputs, force=True
    )  # second files that exist are judged by their content
    loaded = load(cube).fill_missing() if fill_missing else load(cube)
    say(f"{path}: {_write(loaded, path, style, force=force, **settings)}")


def _write(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    """Write a cube, and return a description of the file."""
    from uplift.common.files import write_text
    from uplift.extras import export
    from uplift.extras.report.live_page import page

    data = cube.data
    if style in LUTS:
        error = export.write_lut(cube, path=path, **settings)
        return f"colours under {settings['light']}, {_shown(error)}"
    if style == "fourier":
        error = export.write_fourier(cube, path, **settings)
        _, shader = export.output_files(path, style)
        return f"shader in {shader}, with 8 bits {_shown(error)}"
    if style == "film":
        film = export.write_film(cube, path, **settings)
        return (
            f"{film.inside:.0%} of the chromaticities from the cube, mean error of "
            f"exposure {film.stops:.2g} stops"
        )
    if style in SIGMOIDS:
        with progress_bar("fitting sigmoids"):
            error = export.write_coeff(data, path, layout=style, **settings)
        return f"table of sigmoids, {_shown(error)}"
    if style == "npz":
        return pluralise(export.write_npz(data, path, **settings), "array")
    if style == "csv":
        return pluralise(export.write_csv(data, path, **settings), "node")
    if style == "html":
        write_text(page(data), path, **settings)
        return f"page, {path.stat().st_size / 1e6:.1f} MB"
    return _write_program(data, path, style, **settings)


def _write_program(
    data: CubeData,
    path: Path,
    style: str,
    *,
    force: bool,
    mode: str = "spectra",
    table: str | None = None,
) -> str:
    """Write a program, and return a description of it."""
    from uplift.extras import export

    written = export.write_program(
        data, path, style=style, mode=mode, form=table, force=force
    )
    size = sum(each.stat().st_size for each in written) / 1e6
    nodes = pluralise(data.lattice.size, "node")
    facts = [nodes, pluralise(len(data.atlas.names), "atlas entry"), f"{size:.1f} MB"]
    facts.append(
        "single precision changes reflectances by less than "
        f"{round_up(export.rounding_error(data, mode)):g}"
    )
    moved = export.moved_cells(data, mode).sum() / (data.lattice.dim - 1) ** 3
    if moved:
        facts.append(f"more in {moved:.0%} of the cells, next to unrealisable colours")
    facts += [f"table in {each}" for each in written[1:]]
    return ", ".join(facts)


def _shown(error: TableError) -> str:
    """Describe the errors of a table."""
    worst = " ".join(f"{value:.2g}" for value in error.worst)
    return (
        f"ΔE00 from the cube's: mean {error.mean:.2g}, largest "
        f"{round_up(error.largest):g} (RGB {worst})"
    )
