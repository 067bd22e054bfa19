"""``uplift export``: write a cube in formats of other tools."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise, round_up

from .. import options
from ..output.console import say
from ..output.progress import progress_bar
from ..outputs import stated_inputs

if TYPE_CHECKING:
    from uplift.extras.export import TableError
    from uplift.lookup import Cube


@dataclass(frozen=True)
class Export:
    """A format: its suffix, the options that apply to it, and its writer, which returns
    a description of the file.
    """

    suffix: str
    options: tuple[str, ...]
    write: Callable[..., str]


def _write_lut(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    error = export.write_lut(cube, path=path, **settings)
    return f"colours under {settings['light']}, {_shown(error)}"


def _write_fourier(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    error = export.write_fourier(cube, path, **settings)
    _, shader = export.output_files(path, style)
    return f"shader in {shader}, with 8 bits {_shown(error)}"


def _write_film(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    film = export.write_film(cube, path, **settings)
    return (
        f"{film.inside:.0%} of the chromaticities from the cube, mean error of "
        f"exposure {film.stops:.2g} stops"
    )


def _write_sigmoids(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    with progress_bar("fitting sigmoids"):
        error = export.write_coeff(cube.data, path, layout=style, **settings)
    return f"table of sigmoids, {_shown(error)}"


def _write_npz(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    return pluralise(export.write_npz(cube.data, path, **settings), "array")


def _write_csv(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.extras import export

    return pluralise(export.write_csv(cube.data, path, **settings), "node")


def _write_html(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    from uplift.common.files import write_text
    from uplift.extras.report.live_page import page

    write_text(page(cube.data), path, **settings)
    return f"page, {path.stat().st_size / 1e6:.1f} MB"


def _write_program(
    cube: Cube,
    path: Path,
    style: str,
    *,
    force: bool,
    mode: str = "spectra",
    table: str | None = None,
) -> str:
    """Write a program, and return a description of it."""
    from uplift.extras import export

    data = cube.data
    written = export.write_program(
        data, path, style=style, mode=mode, form=table, force=force
    )
    size = sum(file.stat().st_size for file in written) / 1e6
    nodes = pluralise(data.lattice.size, "node")
    facts = [nodes, pluralise(len(data.atlas.names), "atlas entry"), f"{size:.1f} MB"]
    facts.append(
        "single precision changes reflectances by less than "
        f"{round_up(export.rounding_error(data, mode)):g}"
    )
    moved = export.moved_cells(data, mode).sum() / (data.lattice.dim - 1) ** 3
    if moved:
        facts.append(f"more in {moved:.0%} of the cells, next to unrealisable colours")
    facts += [f"table in {file}" for file in written[1:]]
    return ", ".join(facts)


def _shown(error: TableError) -> str:
    """Describe the errors of a table."""
    worst = " ".join(f"{value:.2g}" for value in error.worst)
    return (
        f"ΔE00 from the cube's: mean {error.mean:.2g}, largest "
        f"{round_up(error.largest):g} (RGB {worst})"
    )


PROGRAM = ("mode", "table")
LUT = ("res", "light", "adapt")
EXPORTS = {
    "coeff": Export(".coeff", ("res",), _write_sigmoids),
    "luisa": Export(".cpp", (), _write_sigmoids),
    "pbrt": Export(".cpp", (), _write_sigmoids),
    "c": Export(".h", PROGRAM, _write_program),
    "cuda": Export(".cuh", PROGRAM, _write_program),
    "glsl": Export(".glsl", PROGRAM, _write_program),
    "hlsl": Export(".hlsl", PROGRAM, _write_program),
    "cube": Export(".cube", LUT, _write_lut),
    "clf": Export(".clf", LUT, _write_lut),
    "film": Export(".npy", ("res", "light"), _write_film),
    "fourier": Export(".png", ("res",), _write_fourier),
    "npz": Export(".npz", (), _write_npz),
    "csv": Export(".csv", (), _write_csv),
    "html": Export(".html", (), _write_html),
}
"""Formats by name; of one suffix the last is the default."""


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
    type=click.Choice(tuple(EXPORTS)),
    metavar="FORMAT",
    help="Format to write. [default: by the suffix of --output]",
)
@options.whole(
    "--res",
    help="Nodes of a table along each axis. [default: coeff 64, cube, clf and fourier "
    "33, film 192]",
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
    help="What programs interpolate: spectra, with exact colours, or coefficients. "
    "[default: spectra]",
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
    style = _find_format(style, output)
    export = EXPORTS[style]
    settings = {name: value for name, value in given.items() if value is not None}
    _check_settings(export, settings)
    from uplift.common.files import check_output, check_outputs
    from uplift.extras.export import check_form, output_files
    from uplift.lookup import load

    form = style
    if export.options == PROGRAM:
        form = check_form(style, settings.get("table"))
    files = output_files(output or Path(cube).stem + export.suffix, form)
    inputs = stated_inputs()
    path = check_output(files[0], inputs=inputs, force=force)
    # second files that exist are judged by their content
    check_outputs(files, inputs=inputs, force=True)
    loaded = load(cube)
    if fill_missing:
        loaded = loaded.fill_missing()
    say(f"{path}: {export.write(loaded, path, style, force=force, **settings)}")


def _find_format(style: str | None, output: str | None) -> str:
    """Return the format that is given, or else that of the output's suffix."""
    suffixes = {export.suffix: name for name, export in EXPORTS.items()}
    if style is None and output is not None:
        suffix = Path(output).suffix.lower()
        style = suffixes.get(".cuh" if suffix == ".cu" else suffix)
    if style is None:
        raise click.UsageError(
            f"Give --format, or --output ending in {', '.join(suffixes)}."
        )
    return style


def _check_settings(export: Export, settings: Collection[str]) -> None:
    for name in settings:
        if name not in export.options:
            formats = [key for key in EXPORTS if name in EXPORTS[key].options]
            raise click.UsageError(f"--{name} applies to {', '.join(formats)} only.")
    if export.options == LUT and "light" not in settings:
        raise click.UsageError(
            "A cube or clf table shows the colours under a light: give --light, such "
            "as HP1."
        )
