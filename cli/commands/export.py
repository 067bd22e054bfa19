"""``uplift export``: write a cube in formats of other tools."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import click

from uplift.common.extensions import import_part
from uplift.extras.export.registry import known_exports

from .. import options
from ..output.console import say
from ..output.progress import progress_bar
from ..outputs import stated_inputs

EXPORTS = known_exports()
WIDTH = 6
"""Characters of names of formats before what they are."""


PAINTS = ".toml"
"""Suffix of files of paints."""
HEADER = ("C and C++", "uplift.extras.export.runtime:write_header")
MODULE = ("JavaScript", "uplift.extras.export.module:write_module")
READERS = {
    ".h": HEADER,
    ".hpp": HEADER,
    ".hh": HEADER,
    ".js": MODULE,
    ".mjs": MODULE,
}
"""Languages of the files that read cubes, and the functions that write them, by suffix.
"""


def _summary() -> str:
    """Describe the formats for the help; those of one kind on one line."""
    lines = []
    for about, names in groupby(EXPORTS, key=lambda name: EXPORTS[name].about):
        joined = ", ".join(names)
        first, *others = about.split("; ")
        indent = " " * (WIDTH + 1)
        if len(joined) > WIDTH:
            lines += [joined, indent + first]
        else:
            lines.append(f"{joined:<{WIDTH}} {first}")
        if others:
            lines[-1] += ";"
            lines += [indent + text for text in others]
    return "\n".join(f"    {line}" for line in lines)


HELP = """Write a cube in a format that other tools read.

    \b
{formats}

    A file of paints (.toml) is written as a program that mixes them (.h, .glsl, .hlsl),
    as a page (.html), or as a table of two of them (.cube).

    Names in a program start with the file's. A C header, also valid C++, contains the
    table, or loads it from a file of numbers. Programs in other languages come with a
    second file, which they explain. --runtime writes what reads cube files when a
    program runs instead: uplift.h, a C header, or uplift.js, a module for browsers and
    node. The tables of coeff, pbrt and luisa store sigmoid spectra of the cube's
    colours: three coefficients cannot represent the atlas.

    \b
    Examples:
      uplift export macbeth-32.uplift -o macbeth-32.npz
      uplift export macbeth-32.uplift -o srgb.coeff
      uplift export macbeth-32.uplift -o rgbspectrum_srgb.cpp
      uplift export macbeth-32.uplift -o cube.h
      uplift export macbeth-32.uplift -o filed.h --table file
      uplift export macbeth-32.uplift -o moments.glsl --mode moments
      uplift export macbeth-32.uplift -o sodium.cube --light HP1
      uplift export macbeth-32.uplift -o film.npy
      uplift export macbeth-32.uplift -o paint.h --format mixer-c
      uplift export --runtime uplift.h
      uplift export --runtime uplift.js
      uplift paints fit swatches.csv -o paints.toml
      uplift export paints.toml -o mixer.glsl
      uplift export paints.toml --paint 'deep blue' --paint 'warm red' -o two.cube
    """


@click.command(
    "export",
    cls=options.Command,
    everyday=("output", "style", "light", "table", "runtime", "force"),
    help=HELP.replace("{formats}", _summary()),
)
@click.argument(
    "cube", metavar="[CUBE]", required=False, shell_complete=options.complete_cube
)
@options.output(help="File to write. [default: CUBE's name in the current folder]")
@click.option(
    "--format",
    "style",
    type=click.Choice(tuple(EXPORTS)),
    metavar="FORMAT",
    help="Format to write. [default: by the suffix of --output]",
)
@click.option(
    "--res",
    type=options.WHOLE,
    help=(
        "Nodes of a table along each axis. [default: coeff 64, cube and clf 33, film "
        "192, mixers 17]"
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
@click.option(
    "--runtime",
    is_flag=True,
    help="Write uplift.h or uplift.js, which read cube files, instead of a cube.",
)
@options.repeatable(
    "--paint", "names", "Paint of a file of paints", "all", metavar="NAME"
)
@options.force
def command(
    cube: str | None,
    output: str | None,
    style: str | None,
    fill_missing: bool,
    runtime: bool,
    names: Sequence[str],
    force: bool,
    **given: Any,
) -> None:
    if runtime:
        unused = (style, fill_missing or None, names or None, *given.values())
        if any(value is not None for value in unused):
            raise click.UsageError("--runtime goes with --output and --force only.")
        _write_runtime(cube, output, force=force)
        return
    if cube is None:
        raise click.UsageError("Give a cube, or --runtime.")
    if Path(cube).suffix.lower() == PAINTS:
        if fill_missing or any(value is not None for value in given.values()):
            raise click.UsageError(
                "Paints take --output, --format, --paint and --force only."
            )
        _export_paints(cube, output, style, names, force=force)
        return
    if names:
        raise click.UsageError("--paint applies to a file of paints.")
    style = style or _style_of(output)
    export = EXPORTS[style]
    settings = {name: value for name, value in given.items() if value is not None}
    for name in settings:
        if name not in export.options:
            formats = [key for key in EXPORTS if name in EXPORTS[key].options]
            raise click.UsageError(f"--{name} applies to {', '.join(formats)} only.")
    if "adapt" in export.options and "light" not in settings:
        raise click.UsageError(
            "A cube or clf table shows the colours under a light: give --light, such "
            "as HP1."
        )
    from uplift.common.files import check_output
    from uplift.extras.export.outputs import output_files
    from uplift.extras.export.program import check_form
    from uplift.extras.files.outputs import check_outputs
    from uplift.lookup.cube import load

    form = style
    if "table" in export.options:
        form = check_form(style, settings.get("table"))
    files = output_files(output or Path(cube).stem + export.suffix, form)
    inputs = stated_inputs()
    path = check_output(files[0], inputs=inputs, force=force)
    # Second files that exist are judged by their content.
    check_outputs(files, inputs=inputs, force=True)
    loaded = load(cube).fill_missing() if fill_missing else load(cube)
    write = import_part(export.writer)
    with progress_bar(f"writing {path}"):
        written = write(loaded, path, style, force=force, **settings)
    say(f"{path}: {written}")


def _write_runtime(name: str | None, output: str | None, *, force: bool) -> None:
    """Write what reads cube files, to a name after the option or to the output."""
    if name is not None and output is not None:
        raise click.UsageError("--runtime writes one file: give it once.")
    from uplift.common.files import check_output

    path = check_output(output or name or "uplift.h", force=force)
    suffix = path.suffix.lower()
    if suffix not in READERS:
        raise click.UsageError(
            f"--runtime writes files that end in {', '.join(READERS)}, got {path}: C "
            "and C++, or an ES module, which CommonJS loads by await import()."
        )
    language, writer = READERS[suffix]
    import_part(writer)(path, force=force)
    size = path.stat().st_size / 1e3
    say(f"{path}: reads cube files in {language}, {size:.0f} kB")


def _export_paints(
    path: str,
    output: str | None,
    style: str | None,
    names: Sequence[str],
    *,
    force: bool,
) -> None:
    """Write paints as a program, a table or a page."""
    from uplift.common.files import check_output
    from uplift.extras.paint.paint_exports import PAINT_EXPORTS
    from uplift.extras.paint.paints_file import read_paints

    by_suffix = {suffix: name for name, (suffix, _) in PAINT_EXPORTS.items()}
    style = style or by_suffix.get(Path(output or "").suffix.lower())
    if style not in PAINT_EXPORTS:
        raise click.UsageError(
            f"Give --output ending in {', '.join(by_suffix)}, or --format for paints: "
            f"{', '.join(PAINT_EXPORTS)}."
        )
    suffix, write = PAINT_EXPORTS[style]
    target = check_output(
        output or Path(path).stem + suffix, inputs=[path], force=force
    )
    paints = read_paints(path)
    if names:
        paints = paints.select(names)
    with progress_bar(f"writing {target}"):
        written = write(paints, target, style, force=force)
    say(f"{target}: {written}")


def _style_of(output: str | None) -> str:
    """Return the format of a file by its suffix. Raise `click.UsageError`."""
    suffixes = dict[str, str]()
    for name, export in EXPORTS.items():
        suffixes.setdefault(export.suffix, name)
    suffix = Path(output or "").suffix.lower()
    style = suffixes.get(".cuh" if suffix == ".cu" else suffix)
    if style is None:
        raise click.UsageError(
            f"Give --format, or --output ending in {', '.join(suffixes)}."
        )
    return style
