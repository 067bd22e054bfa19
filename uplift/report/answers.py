"""Stored answers of a cube compared with those that it gives now: a test of what a renderer's users rely on."""

import csv
import math
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import ColourError
from uplift.common.files import read_bytes
from uplift.common.text import parse_float
from uplift.lookup import Cube

MAX_BYTES = 1 << 28


@dataclass(frozen=True, eq=False)
class StoredAnswers:
    """Linear RGB (n, 3), wavelengths (N,) in nm, and reflectance (n, N), as ``query --format csv`` writes them."""

    rgb: Array
    wavelengths: Array
    reflectance: Array

    def differences(self, cube: Cube, mode: str = "spectra") -> Array:
        """Return the largest absolute difference (n,) between a stored reflectance and that of a cube."""
        answers = cube.reflectance(self.rgb, self.wavelengths, mode=mode)
        return np.asarray(np.abs(answers - self.reflectance).max(axis=-1))


def read_answers(path: StrPath) -> StoredAnswers:
    """Read stored answers: columns ``r``, ``g``, ``b``, and one of reflectance for each wavelength. Others are ignored.

    Raises `ColourError` for a file that cannot be read, or that has no such table.
    """
    data = read_bytes(path, ColourError, limit=MAX_BYTES, hint="name a CSV file of answers")
    try:
        header, *rows = csv.reader(data.decode("utf-8", errors="replace").splitlines()) if data else [[]]
    except csv.Error as error:
        raise ColourError(f"is not CSV: {error}", path=path, hint="name a CSV file of answers") from error
    wanted = {name: column for column, name in enumerate(header)}
    at = {value: column for name, column in wanted.items() if math.isfinite(value := _number(name))}
    if not {"r", "g", "b"} <= wanted.keys() or not at or not rows:
        raise ColourError(
            "must have columns r, g and b, columns of wavelengths, and rows",
            path=path,
            hint="write it as queries are written in CSV",
        )
    columns = [wanted[name] for name in "rgb"] + [at[nm] for nm in sorted(at)]
    values = np.full((len(rows), len(columns)), np.nan)
    for number, row in enumerate(rows):
        values[number] = [_number(row[column]) if column < len(row) else math.nan for column in columns]
        if not np.isfinite(values[number]).all():
            raise ColourError("each column needs a finite number", path=path, line=number + 2, hint="correct the row")
    return StoredAnswers(values[:, :3], np.array(sorted(at)), values[:, 3:])


def _number(text: str) -> float:
    try:
        return parse_float(text)
    except ValueError:
        return math.nan
