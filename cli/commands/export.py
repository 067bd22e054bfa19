"""``uplift export``: write a cube in formats of other tools."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import click

from uplift.common.errors import StrPath
from uplift.common.extensions import import_part
from uplift.extras.export.registry import (
    PAINT_EXPORTS,
    RUNTIMES,
    Export,
    known_exports,
)

from .. import options
from ..output.console import say
from ..output.progress import progress_bar
from ..outputs import stated_inputs

EXPORTS = known_exports()
WIDTH = 6
"""Characters of names of formats before what they are."""


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
@click.argument("cube", metavar="[CUBE]", required=False, type=options.CUBE)
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
    "--paint", "paint", "Paint of a file of paints", "all", metavar="NAME"
)
@options.force
def command(
    cube: str | None,
    output: str | None,
    style: str | None,
    fill_missing: bool,
    runtime: bool,
    force: bool,
    **given: Any,
) -> None:
    settings = {name: value for name, value in given.items() if value not in (None, ())}
    if fill_missing:
        settings["fill_missing"] = True
    if runtime and cube and output:
        raise click.UsageError("--runtime writes one file: give it once.")
    if runtime:
        source, output = READERS, output or cube or "uplift.h"
    elif cube is None:
        raise click.UsageError("Give a cube, or --runtime.")
    else:
        source = PAINTS if Path(cube).suffix.lower() == ".toml" else CUBES
    inputs = () if runtime else stated_inputs()
    write_export(source, cube, output, style, settings, inputs=inputs, force=force)


def write_export(
    source: Source,
    name: str | None,
    output: str | None,
    style: str | None,
    settings: dict[str, Any],
    *,
    inputs: Sequence[StrPath],
    force: bool,
) -> None:
    """Write what is read by its name in a format, by default that of the suffix."""
    from uplift.common.files import check_output
    from uplift.extras.export.outputs import output_files
    from uplift.extras.export.program import check_form
    from uplift.extras.files.outputs import check_outputs

    style = style or _style_of(output, source.formats)
    if style not in source.formats:
        formats = ", ".join(source.formats)
        raise click.UsageError(f"--format must be one of {formats}, got {style}.")
    export = source.formats[style]
    for key in settings.keys() - {source.option, *export.options}:
        option = key.replace("_", "-")
        raise click.UsageError(f"--{option} does not apply to the format {style}.")
    if "adapt" in export.options and "light" not in settings:
        raise click.UsageError(
            "A cube or clf table shows the colours under a light: give --light, such "
            "as HP1."
        )
    form = style
    if "table" in export.options:
        form = check_form(style, settings.get("table"))
    files = output_files(output or Path(name or "").stem + export.suffix, form)
    path = check_output(files[0], inputs=inputs, force=force)
    # Second files that exist are judged by their content.
    check_outputs(files, inputs=inputs, force=True)
    content: Any = import_part(source.reader)(name) if source.reader else None
    if settings.pop("fill_missing", None):
        content = content.fill_missing()
    if names := settings.pop("paint", None):
        content = content.select(names)
    write = import_part(export.writer)
    with progress_bar(f"writing {path}"):
        written = write(content, path, style, force=force, **settings)
    say(f"{path}: {written}")


@dataclass(frozen=True)
class Source:
    """What is exported: its formats, the function that reads it, as
    ``"module:function"``, and an option that selects a part of it.
    """

    formats: Mapping[str, Export]
    reader: str = ""
    option: str = ""


CUBES = Source(EXPORTS, "uplift.lookup.cube:load", "fill_missing")
PAINTS = Source(PAINT_EXPORTS, "uplift.extras.paint.paints_file:read_paints", "paint")
READERS = Source(RUNTIMES)


def _style_of(output: str | None, formats: Mapping[str, Export]) -> str:
    """Return the format of a file by its suffix. Raise `click.UsageError`."""
    suffix = Path(output or "").suffix.lower()
    suffix = ".cuh" if suffix == ".cu" else suffix
    for name, export in formats.items():
        if export.suffix == suffix:
            return name
    known = list(dict.fromkeys(export.suffix for export in formats.values()))
    choice = "" if len(known) == len(formats) else "--format, or "
    raise click.UsageError(f"Give {choice}--output ending in {', '.join(known)}.")
