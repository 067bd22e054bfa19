"""A cube as a program for renderers and shaders, in one of several languages."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import OptionError, UpliftWarning
from uplift.common.files import atomic_write, check_output
from uplift.cube import CubeData, digest
from uplift.io.export.containers import dds, ktx2
from uplift.io.export.kernel import language
from uplift.io.export.kernel.language import Language
from uplift.io.export.kernel.program import Program
from uplift.io.export.kernel.table import MODES, Table, make_table

LARGE = 16_000_000
"""Size in bytes above which compilation of a header is slow."""


@dataclass(frozen=True)
class Format:
    """The files of a language.

    Parameters
    ----------
    language : Language
        The language.
    suffix : str
        Suffix of the program.
    tables : tuple of str
        Where the table can be, the default first: in the program, a ``"header"``, in a ``"file"`` of numbers or in
        ``"textures"``.
    file, texture : str
        Suffixes of a file of numbers, and of textures.
    """

    language: Language
    suffix: str
    tables: tuple[str, ...]
    file: str = ".bin"
    texture: str = ".ktx2"

    @property
    def template(self) -> str:
        """Name of the template."""
        name = next(name for name, each in FORMATS.items() if each is self)
        return "c.h" if name == "c" else f"{name}{self.suffix}"


FORMATS = {
    "c": Format(language.C, ".h", ("header", "file")),
    "cuda": Format(language.CUDA, ".cuh", ("file",)),
    "glsl": Format(language.GLSL, ".glsl", ("file", "textures")),
    "hlsl": Format(language.HLSL, ".hlsl", ("file", "textures"), texture=".dds"),
    "osl": Format(language.OSL, ".osl", ("file",), file=".exr"),
    "wgsl": Format(language.WGSL, ".wgsl", ("file", "textures")),
}
"""Languages of `write_program`."""


def write_program(
    data: CubeData,
    path: str | os.PathLike[str],
    *,
    style: str = "c",
    mode: str = "spectra",
    form: str | None = None,
    force: bool = False,
) -> list[Path]:
    """Write a cube as a program that evaluates it in single precision.

    Names in the program begin with the name of the file, converted to an identifier. A C header contains its table, by
    default. Other programs read it from files with the same stem: float32 numbers, little-endian, an OpenEXR image for
    OSL, or textures in KTX 2 or DDS. The program states how to load them.

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
    form : {"header", "file", "textures"}, optional
        Where the table is: in the program, for C only, the default there; in a file of numbers, the default elsewhere;
        or, for GLSL, HLSL and WGSL, in 3-D textures of the lattice and one of the rest.
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
        language (code ``unknown-language``), mode (code ``unknown-mode``) or form for the language (code
        ``unknown-table``).
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
        raise OptionError(f"unknown mode '{mode}'", code="unknown-mode", hint=f"use one of {', '.join(MODES)}")
    if data.complete_cells is not None:
        raise OptionError(
            "a program needs all nodes, but the cube was built for the colours of a scene",
            code="sparse-cube",
            hint="pass cube.fill_missing().data",
        )
    path, output = Path(path), FORMATS[style]
    form = form or output.tables[0]
    if form not in output.tables:
        raise OptionError(
            f"a program in {style} has no table of the form '{form}'",
            code="unknown-table",
            hint=f"use {' or '.join(output.tables)}",
        )
    table = make_table(data, mode)
    tables = _tables(data, table, path, output, form)
    for each in tables:
        check_output(each, force=force)
    program = Program(data, table, mode, identifier(path.stem), output.language, output.template, form, path.stem)
    with atomic_write(path, force=force) as temporary:
        with temporary.open("w", encoding="ascii", newline="\n") as opened:
            opened.writelines(program.parts())
        size = temporary.stat().st_size
    for each, write in tables.items():
        with atomic_write(each, force=force) as temporary:
            write(temporary)
    if size > LARGE:
        problem = f"the header has {size / 1e6:.0f} MB and is slow to compile"
        warning = UpliftWarning(problem, code="large-header", path=path, hint="use a cube of smaller dim")
        warnings.warn(warning, stacklevel=2)
    return [path, *tables]


def identifier(stem: str) -> str:
    """Convert a file name to an identifier: 'macbeth-32' → 'macbeth_32', '32' → 'cube_32'."""
    name = re.sub(r"\W+|__+", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z]", name) else f"cube_{name}".rstrip("_")


def _tables(
    data: CubeData, table: Table, path: Path, output: Format, form: str
) -> dict[Path, Callable[[Path], object]]:
    """Return the files of a table, and how each is written."""
    if form == "header":
        return {}
    if form == "file":
        write = _write_exr if output.file == ".exr" else write_numbers
        return {path.with_suffix(output.file): partial(write, table.image())}
    textures = {str(t): texels for t, texels in enumerate(table.points())} | {"entries": table.others()}
    notes = {"KTXwriter": "uplift", "cube": digest(data)}
    encode = dds if output.texture == ".dds" else partial(ktx2, notes=notes)
    return {
        path.with_name(f"{path.stem}-{name}{output.texture}"): partial(_write_texture, encode, texels)
        for name, texels in textures.items()
    }


def write_numbers(image: NDArray[np.float32], path: Path) -> None:
    """Write float32 numbers, little-endian."""
    path.write_bytes(image.astype("<f4").tobytes())


def _write_texture(encode: Callable[..., bytes], texels: NDArray[np.float32], path: Path) -> None:
    path.write_bytes(encode(texels))


def _write_exr(image: NDArray[np.float32], path: Path) -> None:
    import OpenEXR

    channels = {"RGBA": np.ascontiguousarray(image)}
    OpenEXR.File({"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}, channels).write(
        os.fspath(path)
    )
