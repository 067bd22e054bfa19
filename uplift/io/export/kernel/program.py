"""A cube as a program: the kernel in one language, with its constants and the access to its table."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from string import Template
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.version import VERSION
from uplift.cube import CubeData, digest
from uplift.io.export.kernel import (
    answer_moments,
    answer_spectra,
    coefficients,
    entries,
    lanes,
    lattice,
    moments,
    nodes_at_once,
    nodes_in_turn,
    sigmoid,
    spectra,
)
from uplift.io.export.kernel.language import Language
from uplift.io.export.kernel.light_table import LightTable
from uplift.io.export.kernel.table import COLUMNS, TEXEL, Table
from uplift.io.export.kernel.translate import functions, literal, translate
from uplift.models import Moments

WARPS = {"none": "wavelength", "vision": "{tanh}(0.0072{suffix} * (wavelength - 538.0{suffix}))"}
"""`uplift.models.phase.WARPS` as expressions."""
LEFT_OUT = {
    "spectra": {"sum_nodes", "sum_coefficients", "dual", "multipliers_of"},
    "moments": {"add_nodes", "add_spectrum"},
}
"""Functions that a mode does not need."""


@dataclass(frozen=True, eq=False)
class Program:
    """Text of a program in one language.

    Parameters
    ----------
    data : CubeData
        The cube.
    table : Table
        Its numbers.
    mode : {"spectra", "moments"}
        What is interpolated.
    name : str
        Prefix of all names.
    language : Language
        The language.
    template : str
        Name of the template: the parts of a program that differ by language.
    form : {"header", "file", "textures"}
        Where the table is.
    stem : str
        Name of the files of the table, without suffix.
    """

    data: CubeData
    table: Table
    mode: str
    name: str
    language: Language
    template: str
    form: str
    stem: str

    def parts(self) -> Iterator[str]:
        """Yield the text piece by piece."""
        stride = self.table.constants["STRIDE"]
        text = Template(read_template(self.template)).safe_substitute(self._words())
        yield from with_numbers(text, self.table.numbers, stride, self.language)

    def _words(self) -> dict[str, Any]:
        sensor, constants = self.data.sensor, self.table.constants
        words = {
            "digest": digest(self.data),
            "space": comment(sensor.space),
            "illuminant": comment(sensor.illuminant),
            "observer": comment(sensor.observer),
            "entries": len(self.data.atlas.names),
            "mode": self.mode,
            "texels": constants["STRIDE"] // TEXEL,
            "tag_texture": constants["COUNT"] // TEXEL,
            "tag_channel": constants["COUNT"] % TEXEL,
            "stride": constants["STRIDE"],
            **table_words(self.table, self.stem, self.name, self.language),
        }
        parts = {"kernel": self._kernel()}
        for key, names in {"access": ("numbers", self.form), "wrappers": (self.mode,)}.items():
            texts = (
                read_template(self.template, part) for part in names if (part, self.form) != ("numbers", "textures")
            )
            parts[key] = Template(repeat("".join(texts), words["texels"])).safe_substitute(words)
        return words | parts

    def _kernel(self) -> str:
        is_moments = isinstance(self.data.model, Moments)
        model = moments if is_moments else sigmoid
        parts = functions(model, spectra, lattice, entries, *self._answer())
        integers = {key: value for key, value in self.table.constants.items() if isinstance(value, int)}
        kept = [part for part in parts if part.name not in LEFT_OUT[self.mode]]
        return (self._warp() if is_moments else "") + translate(kept, self.language, self.name, integers)

    def _answer(self) -> list[ModuleType]:
        """Return the modules of the mode."""
        at_once = nodes_at_once if self.language.lanes else nodes_in_turn
        if self.mode == "moments":
            return [at_once, coefficients, *([lanes] if self.language.lanes else []), answer_moments]
        return [at_once if isinstance(self.data.model, Moments) else nodes_in_turn, answer_spectra]

    def _warp(self) -> str:
        model = self.data.model
        assert isinstance(model, Moments)
        tanh = self.language.functions.get("tanh", "tanh")
        expression = WARPS[model.phase.warp].format(tanh=tanh, suffix=self.language.suffix)
        return self.language.warp.format(
            name=self.name, NAME=self.name.upper(), function=self.language.function, expression=expression
        ).format(NAME=self.name.upper())


def read_template(template: str, part: str = "") -> str:
    """Read a template, or a part of it.

    Parameters
    ----------
    template : str
        Name of the template.
    part : str
        Prefix of the part; none for the template itself.

    Returns
    -------
    str
        Empty if the language has no such part.
    """
    name = f"{part}.{template}" if part else template
    path = files("uplift.io.export") / "templates" / name
    return path.read_text(encoding="ascii") if path.is_file() else ""


def table_words(table: Table | LightTable, stem: str, name: str, language: Language) -> dict[str, Any]:
    """Return the words of a program that describe its table.

    Parameters
    ----------
    table : Table or LightTable
        The table.
    stem : str
        Name of its files, without suffix.
    name : str
        Prefix of all names.
    language : Language
        The language.

    Returns
    -------
    dict
        Values of the words of templates.
    """
    image = table.image()
    return {
        "version": VERSION,
        "size": image.size,
        "checksum": zlib.crc32(image.astype("<f4").tobytes()),
        "columns": COLUMNS,
        "rows": len(image),
        "stem": comment(stem),
        "name": name,
        "NAME": name.upper(),
        "constants": declare(table.constants, language, name),
    }


def declare(constants: Mapping[str, int | float], language: Language, name: str) -> str:
    """Declare constants in a language, a line each; their names begin with ``name`` in capitals."""
    lines = []
    for key, value in constants.items():
        text = literal(value) + language.suffix if isinstance(value, float) else str(value)
        kind = language.types["Float" if isinstance(value, float) else "Int"]
        lines.append(language.constant.format(name=f"{name.upper()}_{key}", value=text, type=kind))
    return "\n".join(lines)


def with_numbers(text: str, numbers: NDArray[np.float32], stride: int, language: Language) -> Iterator[str]:
    """Yield a program with its table as text, ``stride`` numbers a line, where it has the word ``${table}``."""
    before, found, after = text.partition("${table}")
    yield before
    if not found:
        return
    for start in range(0, len(numbers), stride):
        row = numbers[start : start + stride].tolist()
        yield ", ".join(literal(number) + language.suffix for number in row) + ",\n"
    yield after


def comment(text: str) -> str:
    """Return text that cannot end a comment; names in a cube file are arbitrary."""
    return text.encode("ascii", "replace").decode().replace("*", "").replace("\n", " ").replace("$", "")


def repeat(text: str, count: int) -> str:
    """Repeat each line that has ``${t}`` for t = 0, 1, ..."""
    lines = text.splitlines(keepends=True)
    return "".join(line.replace("${t}", str(t)) for line in lines for t in range(count if "${t}" in line else 1))
