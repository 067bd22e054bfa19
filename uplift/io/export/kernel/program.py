"""A cube as a program: the kernel in one language, with its constants and the access to its table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files
from string import Template
from types import ModuleType
from typing import Any

from uplift.common.version import VERSION
from uplift.cube import CubeData, digest
from uplift.io.export.kernel import (
    add_nodes,
    add_nodes_in_passes,
    answer_moments,
    answer_spectra,
    entries,
    lanes,
    lattice,
    moments,
    sigmoid,
    spectra,
)
from uplift.io.export.kernel.language import Language
from uplift.io.export.kernel.table import COLUMNS, Table
from uplift.io.export.kernel.translate import functions, literal, translate
from uplift.models import Moments

WARPS = {"none": "wavelength", "vision": "{tanh}(0.0072{suffix} * (wavelength - 538.0{suffix}))"}
"""`uplift.models.phase.WARPS` as expressions."""
LEFT_OUT = {
    "spectra": {"sum_nodes", "sum_coefficients", "dual", "multipliers_of"},
    "moments": {"add_spectrum"},
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
    file : str
        Name of the separate file of the table, if any.
    """

    data: CubeData
    table: Table
    mode: str
    name: str
    language: Language
    template: str
    file: str

    def parts(self) -> Iterator[str]:
        """Yield the text piece by piece."""
        text = Template(_read(self.template)).safe_substitute(self._words())
        before, found, after = text.partition("${table}")
        yield before
        if found:
            yield from self._numbers()
            yield after

    def _words(self) -> dict[str, Any]:
        sensor, width = self.data.sensor, self.table.constants["STRIDE"] // 4
        wrappers = files("uplift.io.export") / "templates" / f"{self.mode}.{self.template}"
        words = {
            "version": VERSION,
            "digest": digest(self.data),
            "space": comment(sensor.space),
            "illuminant": comment(sensor.illuminant),
            "observer": comment(sensor.observer),
            "entries": len(self.data.atlas.names),
            "mode": self.mode,
            "texels": width,
            "stride": self.table.constants["STRIDE"],
            "size": len(self.table.numbers),
            "columns": COLUMNS,
            "rows": self.table.image().shape[0],
            "file": self.file,
            "name": self.name,
            "NAME": self.name.upper(),
            "constants": self._constants(),
        }
        text = wrappers.read_text(encoding="ascii") if wrappers.is_file() else ""
        return words | {"kernel": self._kernel(), "wrappers": Template(text).safe_substitute(words)}

    def _constants(self) -> str:
        lines = []
        for key, value in self.table.constants.items():
            text = literal(value) + self.language.suffix if isinstance(value, float) else str(value)
            kind = self.language.types["Float" if isinstance(value, float) else "Int"]
            lines.append(
                self.language.constant.format(name=f"{self.name.upper()}_{key}", value=text, type=kind)
            )
        return "\n".join(lines)

    def _kernel(self) -> str:
        is_moments = isinstance(self.data.model, Moments)
        model = moments if is_moments else sigmoid
        parts = functions(model, spectra, lattice, entries, *self._answer())
        integers = {key: value for key, value in self.table.constants.items() if isinstance(value, int)}
        kept = [part for part in parts if part.name not in LEFT_OUT[self.mode]]
        return (self._warp() if is_moments else "") + translate(kept, self.language, self.name, integers)

    def _answer(self) -> list[ModuleType]:
        """Return the modules of the mode."""
        if self.mode == "moments":
            return [lanes, answer_moments] if self.language.lanes else [answer_moments]
        in_passes = self.language.lanes and isinstance(self.data.model, Moments)
        return [add_nodes_in_passes if in_passes else add_nodes, answer_spectra]

    def _warp(self) -> str:
        model = self.data.model
        assert isinstance(model, Moments)
        tanh = self.language.functions.get("tanh", "tanh")
        expression = WARPS[model.phase.warp].format(tanh=tanh, suffix=self.language.suffix)
        return self.language.warp.format(
            name=self.name, NAME=self.name.upper(), function=self.language.function, expression=expression
        ).format(NAME=self.name.upper())

    def _numbers(self) -> Iterator[str]:
        """Yield the table as text, a row per line."""
        stride, numbers = self.table.constants["STRIDE"], self.table.numbers
        for start in range(0, len(numbers), stride):
            row = numbers[start : start + stride].tolist()
            yield ", ".join(literal(number) + self.language.suffix for number in row) + ",\n"


def comment(text: str) -> str:
    """Return text that cannot end a comment; names in a cube file are arbitrary."""
    return text.encode("ascii", "replace").decode().replace("*", "").replace("\n", " ").replace("$", "")


def _read(name: str) -> str:
    return (files("uplift.io.export") / "templates" / name).read_text(encoding="ascii")
