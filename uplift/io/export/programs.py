"""A cube as a program for renderers and shaders, in one of several languages."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.errors import OptionError, UpliftWarning
from uplift.common.files import atomic_write, check_output
from uplift.cube import CubeData
from uplift.io.export.kernel import language
from uplift.io.export.kernel.language import Language
from uplift.io.export.kernel.program import Program
from uplift.io.export.kernel.table import MODES, Table, make_table

LARGE = 16_000_000
"""Size in bytes above which compilation of a header is slow."""


@dataclass(frozen=True)
class Format:
    """The files of a language: suffix of the program, and of the table; empty for a table within the program."""

    language: Language
    suffix: str
    table_suffix: str = ".bin"

    @property
    def template(self) -> str:
        """Name of the template."""
        name = next(name for name, each in FORMATS.items() if each is self)
        return "c.h" if name == "c" else f"{name}{self.suffix}"


FORMATS = {
    "c": Format(language.C, ".h", ""),
    "cuda": Format(language.CUDA, ".cuh"),
    "glsl": Format(language.GLSL, ".glsl"),
    "hlsl": Format(language.HLSL, ".hlsl"),
    "osl": Format(language.OSL, ".osl", ".exr"),
    "wgsl": Format(language.WGSL, ".wgsl"),
}
"""Languages of `write_program`."""


def write_program(
    data: CubeData,
    path: str | os.PathLike[str],
    *,
    style: str = "c",
    mode: str = "spectra",
    force: bool = False,
) -> list[Path]:
    """Write a cube as a program that evaluates it in single precision.

    Names in the program begin with the name of the file, converted to an identifier. A C header contains its table.
    Other languages read it from a second file with the same stem: float32 numbers, little-endian, or an OpenEXR image
    for OSL. The program states how to load it.

    Parameters
    ----------
    data : CubeData
        A cube with all nodes.
    path : path-like
        File to write.
    style : {"c", "cuda", "glsl", "hlsl", "osl", "wgsl"}
        Language.
    mode : {"spectra", "moments"}
        What the program interpolates, as in `Cube.reflectance`: spectra, with exact colours, or coefficients.
    force : bool
        Whether to replace existing files.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    OptionError
        The cube was built for a scene; the program could not reject other colours (code ``sparse-cube``). An unknown
        language (code ``unknown-language``) or mode (code ``unknown-mode``).
    OutputError
        A file cannot be written, or exists and ``force`` is off.

    Warns
    -----
    UpliftWarning
        A header is large (code ``large-header``).
    """
    if style not in FORMATS:
        raise OptionError(
            f"unknown language '{style}'", code="unknown-language", hint=f"use one of {', '.join(FORMATS)}"
        )
    if mode not in MODES:
        raise OptionError(
            f"unknown mode '{mode}'", code="unknown-mode", hint=f"use one of {', '.join(MODES)}"
        )
    if data.complete_cells is not None:
        raise OptionError(
            "a program needs all nodes, but the cube was built for the colours of a scene",
            code="sparse-cube",
            hint="pass cube.fill_missing().data",
        )
    path = Path(path)
    output, table, written = FORMATS[style], make_table(data, mode), [path]
    if output.table_suffix:
        written.append(check_output(path.with_suffix(output.table_suffix), force=force))
    name, file = identifier(path.stem), written[-1].name
    program = Program(data, table, mode, name, output.language, output.template, file)
    with atomic_write(path, force=force) as temporary:
        with temporary.open("w", encoding="ascii", newline="\n") as opened:
            opened.writelines(program.parts())
        size = temporary.stat().st_size
    if output.table_suffix:
        with atomic_write(written[-1], force=force) as temporary:
            _write_table(table, temporary, output.table_suffix)
    if size > LARGE:
        problem = f"the header has {size / 1e6:.0f} MB and is slow to compile"
        warning = UpliftWarning(problem, code="large-header", path=path, hint="use a cube of smaller dim")
        warnings.warn(warning, stacklevel=2)
    return written


def identifier(stem: str) -> str:
    """Convert a file name to an identifier: 'macbeth-32' → 'macbeth_32', '32' → 'cube_32'."""
    name = re.sub(r"\W+|__+", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z]", name) else f"cube_{name}".rstrip("_")


def _write_table(table: Table, path: Path, suffix: str) -> None:
    image = table.image()
    if suffix != ".exr":
        path.write_bytes(image.astype("<f4").tobytes())
        return
    import OpenEXR

    channels = {"RGBA": np.ascontiguousarray(image)}
    OpenEXR.File({"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}, channels).write(
        os.fspath(path)
    )
