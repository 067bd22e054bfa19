"""Programs for renderers and shaders: one C-like source, preceded by macros of each
language.

A program is a heading, and the source of its language, which includes macros, the
lookup and its public functions. In the lookup, ``UP_READS`` and ``UP_TABLE`` are the
parameter and the argument by which CUDA passes the table, and the reader of cube files
passes a cube. `RUNTIME_WORDS` are for that reader.
"""

import zlib
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath
from uplift.common.errors import (
    OptionError,
    OutputError,
    UpliftWarning,
    warn,
)
from uplift.common.files import atomic_write, write_text
from uplift.common.text import pluralise, round_up
from uplift.common.version import version
from uplift.cube.data import CubeData
from uplift.cube.file import digest
from uplift.extras.export.outputs import output_files
from uplift.extras.export.program_table import (
    COLUMNS,
    Table,
    check_complete,
    make_table,
    moved_cells,
)
from uplift.extras.export.rounding import rounding_error
from uplift.extras.export.source import (
    comment,
    identifier,
    literal,
    name_program,
    read_source,
    select,
    unroll,
)
from uplift.extras.files.outputs import check_outputs
from uplift.lookup.cube import Cube

LARGE = 16_000_000
"""Size in bytes above which compilation of a header is slow."""


@dataclass(frozen=True)
class Language:
    """Suffix of programs, suffix of the file of public functions, and wavelengths of
    one call.

    The table is, by ``forms``, the default first: in the program, a ``"header"``, or in
    a ``"file"`` of numbers. ``vector`` is what types such as ``vec3`` begin with, and
    ``rows`` the source that states how rows of the table are read.
    """

    suffix: str
    calls: str
    width: int = 4
    forms: tuple[str, ...] = ("file",)
    vector: str = ""
    rows: str = "copies.c"


LANGUAGES = {
    "c": Language(".h", ".c", 16, ("header", "file"), rows="rows.c"),
    "cuda": Language(".cuh", ".cuh"),
    "glsl": Language(".glsl", ".glsl", vector="vec"),
    "hlsl": Language(".hlsl", ".glsl", vector="float"),
}
"""Languages of `write_program`."""
RUNTIME_WORDS = {
    "UP_READS_CUBE ": "",
    "UP_CUBE ": "",
    "UP_ROW_OF(index)": "index",
    "UP_SAMPLE_ROOM": "UP_SAMPLES",
}
"""Words of the source that are macros in the reader of cube files, and what programs
with the numbers of one cube have instead.
"""


def export(
    cube: Cube,
    path: Path,
    style: str,
    *,
    force: bool,
    mode: str = "spectra",
    table: str | None = None,
) -> str:
    """Write a program and its table."""
    data = cube.data
    written = write_program(data, path, style=style, mode=mode, form=table, force=force)
    size = sum(file.stat().st_size for file in written) / 1e6
    facts = [
        pluralise(data.lattice.size, "node"),
        pluralise(len(data.atlas.names), "atlas entry"),
        f"{size:.1f} MB",
        "single precision changes reflectances by less than "
        f"{round_up(rounding_error(data, mode)):g}",
    ]
    moved = moved_cells(data, mode).sum() / (data.lattice.dim - 1) ** 3
    if moved:
        facts.append(f"more in {moved:.0%} of the cells, next to unrealisable colours")
    facts += [f"table in {file}" for file in written[1:]]
    return ", ".join(facts)


def write_program(
    data: CubeData,
    path: StrPath,
    *,
    style: str = "c",
    mode: str = "spectra",
    form: str | None = None,
    force: bool = False,
) -> list[Path]:
    """Write a cube as a program in C, CUDA, GLSL or HLSL that evaluates it in single
    precision; return the files.

    It begins with a list of its functions. Names in the program begin with the name of
    the file, converted to an identifier. ``mode`` is what it interpolates, as in
    `Cube.reflectance`: "spectra", with exact colours, or coefficients, "moments". The
    table is by ``form`` in the program, a "header", the default of C; or in a "file"
    with the same stem: float32 numbers, little-endian. A cube that was built for a
    scene is an `OptionError` of the code ``sparse-cube``.
    """
    check_complete(data, "a program")
    path = Path(path)
    form = check_form(style, form)
    table = make_table(data, mode)
    text = cube_program(data, table, style, mode, path.stem, form)
    written = write_files(
        text, table, path, form, per_line=table.constants["STRIDE"], force=force
    )
    size = path.stat().st_size
    if size > LARGE:
        problem = f"the header has {size / 1e6:.0f} MB and is slow to compile"
        warn(UpliftWarning(problem, path=path, hint="use a cube of smaller dim"))
    return written


def cube_program(
    data: CubeData, table: Table, style: str, mode: str, stem: str, form: str
) -> str:
    """Return the program of a cube, with ``${numbers}`` in place of the numbers of a
    header.
    """
    sensor = data.sensor
    words = {
        "digest": digest(data),
        "space": comment(sensor.space),
        "illuminant": comment(sensor.illuminant),
        "observer": comment(sensor.observer),
        "entries": len(data.atlas.names),
        "mode": mode,
    }
    return compose("cube", table, style, stem, form, words)


def check_form(style: str, form: str | None) -> str:
    """Return the form of the table, the default of the language if None; raise
    `OptionError` if it has no such form.
    """
    forms = LANGUAGES[style].forms
    if form is not None and form not in forms:
        raise OptionError(
            f"a program in {style} has no table of the form '{form}'",
            hint=f"use {' or '.join(forms)}",
        )
    return form or forms[0]


def compose(
    kind: str, table: Table, style: str, stem: str, form: str, words: dict[str, Any]
) -> str:
    """Return the program of ``kind``, "cube" or "lights", with ``${numbers}`` in place
    of the numbers of a header.

    ``up_`` and ``UP_`` in the source become the name of the program.
    """
    language = LANGUAGES[style]
    image = table.image()
    overview, calls = read_calls(kind, language.calls)
    sources = (language.rows, "locate.c", "cube.c") if kind == "cube" else ("lights.c",)
    lookup = "".join(map(read_source, sources)) + calls
    for word, plain in RUNTIME_WORDS.items():
        lookup = lookup.replace(word, plain)
    constants = {f"UP_{key}": value for key, value in table.constants.items()}
    parts = {
        "overview": overview.replace("UP_VEC", language.vector),
        "program": unroll(select(lookup, constants), constants).rstrip("\n"),
        "table": read_source(f"table_{form}.c"),
    }
    text = read_source(f"{kind}_heading.c") + read_source(f"{style}{language.suffix}")
    text = name_program(Template(text).safe_substitute(parts), stem)
    name = identifier(stem).upper()
    definitions = (
        f"#define {name}_{key} {literal(value)}"
        for key, value in table.constants.items()
    )
    shared = {
        "version": version(),
        "stem": comment(stem),
        "width": language.width,
        "constants": "\n".join(definitions),
        "columns": COLUMNS,
        "rows": len(image),
        "size": image.size,
        "checksum": zlib.crc32(image.tobytes()),
    }
    return Template(text).safe_substitute(shared | words)


def read_calls(kind: str, suffix: str) -> tuple[str, str]:
    """Return what the public functions are, for the heading, and their source."""
    overview, _, calls = read_source(f"{kind}_calls{suffix}").partition(" */\n")
    return overview.removeprefix("/* "), calls


def write_files(
    text: str, table: Table, path: Path, form: str, *, per_line: int, force: bool
) -> list[Path]:
    """Write a program, and its table to a file of the same stem unless it is a header;
    return the files.
    """
    files = output_files(path, form)
    check_outputs(files, force=True)
    image = table.image().tobytes()
    if form == "file":
        is_new = not files[1].exists() or files[1].read_bytes() != image
        if is_new and files[1].exists():
            _check_replaced(files[1], path, force=force)
        write_text(text, path, force=force)
        if is_new:
            with atomic_write(files[1], force=True) as temporary:
                temporary.write_bytes(image)
        return files
    rows = np.split(table.numbers, range(per_line, len(table.numbers), per_line))
    lines = "".join(", ".join(map(literal, row.tolist())) + ",\n" for row in rows)
    write_text(text.replace("${numbers}", lines), path, force=force)
    return files


def _check_replaced(table: Path, program: Path, *, force: bool) -> None:
    """Check that a table with other numbers may be replaced. Programs of one cube in
    several languages share theirs.

    Raise `OutputError`; with ``force``, warn of programs that no longer can read it.
    """
    if not force:
        problem = "exists already with other numbers"
        hint = "pass force=True to replace it, or choose another name"
        raise OutputError(problem, path=table, code="file-exists", hint=hint)
    others = (program.with_suffix(language.suffix) for language in LANGUAGES.values())
    readers = [path.name for path in others if path != program and path.exists()]
    if readers:
        problem = f"replaced; {' and '.join(readers)} can no longer read it"
        warn(UpliftWarning(problem, path=table, hint="export them again"))
