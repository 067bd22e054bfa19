"""Stored answers of a cube compared with those that it gives now: a test of what a
renderer's users rely on.
"""

import math
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import ColourError
from uplift.common.files import read_bytes
from uplift.common.text import parse_float
from uplift.extras.files.csv import parse_csv
from uplift.lookup.cube import Cube

MAX_BYTES = 1 << 28


@dataclass(frozen=True, eq=False)
class StoredAnswers:
    """Linear RGB (n, 3), wavelengths (N,) in nm, and reflectance (n, N), as ``query
    --format csv`` writes them.
    """

    rgb: Array
    wavelengths: Array
    reflectance: Array

    def differences(self, cube: Cube, mode: str = "spectra") -> Array:
        """Return the largest absolute difference (n,) between a stored reflectance and
        that of a cube.
        """
        answers = cube.reflectance(self.rgb, self.wavelengths, mode=mode)
        return np.abs(answers - self.reflectance).max(axis=-1)


def read_answers(path: StrPath, wavelengths: Array | None = None) -> StoredAnswers:
    """Read stored answers: columns ``r``, ``g``, ``b``, and one of reflectance for each
    wavelength, or for each of some ``wavelengths`` in nm. Others are ignored.

    Raises `ColourError` for a file that cannot be read, or that has no such table.
    """
    hint = "name a CSV file of answers"
    data = read_bytes(path, ColourError, limit=MAX_BYTES, hint=hint)
    try:
        rows = parse_csv(data)
    except ValueError as error:
        raise ColourError(f"is not CSV: {error}", path=path, hint=hint) from error
    names = rows[0].keys() if rows else set()
    columns = {nm: name for name in names if math.isfinite(nm := _number(name))}
    if wavelengths is not None:
        columns = {nm: columns[nm] for nm in wavelengths.tolist() if nm in columns}
    if not {"r", "g", "b"} <= names or not columns:
        raise ColourError(
            "must have columns r, g and b, columns of wavelengths, and rows",
            path=path,
            hint="write it as queries are written in CSV",
        )
    known = sorted(columns)
    used = [*"rgb", *map(columns.__getitem__, known)]
    table = np.empty((len(rows), len(used)))
    for number, row in enumerate(rows):
        table[number] = [_number(row[name]) for name in used]
    finite = np.isfinite(table).all(axis=1)
    if not finite.all():
        raise ColourError(
            "each column needs a finite number",
            path=path,
            line=int(finite.argmin()) + 2,
            hint="correct the row",
        )
    return StoredAnswers(table[:, :3], np.array(known), table[:, 3:])


def _number(text: str) -> float:
    try:
        return parse_float(text)
    except ValueError:
        return math.nan
