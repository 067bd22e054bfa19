"""JSON files of rawtoaces: spectral sensitivities of cameras and powers of lamps.

Present files have ``spectral_data`` with an ``index`` of labels and ``data`` by
wavelength. The first versions have a ``range`` of first and last wavelength and step,
and rows of ``sensitivity`` or of ``spec``, the power.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import UpliftError
from uplift.common.files import decode_text, read_bytes
from uplift.common.text import parse_float, parse_json

MAX_BYTES = 1_000_000
HINT = "give JSON of rawtoaces, or a CSV table"
RGB, POWER = ("R", "G", "B"), ("power",)
"""Labels of a camera and of a lamp."""
FIRST_VERSIONS = {"sensitivity": RGB, "spec": POWER}
"""Labels by the key of the values in the first versions."""


@dataclass(frozen=True, eq=False)
class LabelledSpectra:
    """Values (N, C) by wavelength (N,) in nm, ascending, and C labels."""

    labels: tuple[str, ...]
    wavelengths: Array
    values: Array


def is_json(path: StrPath) -> bool:
    """Whether the name of a file is that of JSON."""
    return str(path).casefold().endswith(".json")


def read_spectra(
    path: StrPath, labels: tuple[str, ...], error: type[UpliftError]
) -> LabelledSpectra:
    """Read spectra in the order of ``labels``; raise ``error`` for a file with others,
    or that is not of rawtoaces.
    """
    data = read_bytes(path, error, limit=MAX_BYTES, hint=HINT)
    try:
        table = parse_json(decode_text(data))
    except ValueError as cause:
        raise error("is not a valid JSON file", path=path, hint=HINT) from cause
    try:
        spectra = _parse(table)
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError) as cause:
        raise error(
            "is not JSON of rawtoaces, with spectral_data by wavelength",
            path=path,
            hint=HINT,
        ) from cause
    if sorted(spectra.labels) != sorted(labels):
        problem = (
            f"must have the columns {', '.join(labels)}, got "
            f"{', '.join(spectra.labels)}"
        )
        raise error(problem, path=path, hint="name a file of another kind")
    columns = [spectra.labels.index(label) for label in labels]
    order = np.argsort(spectra.wavelengths)
    return LabelledSpectra(
        labels, spectra.wavelengths[order], spectra.values[order][:, columns]
    )


def _parse(table: dict[str, Any]) -> LabelledSpectra:
    """Parse a table of either version."""
    key = next((key for key in FIRST_VERSIONS if key in table), None)
    if key is not None:
        labels = FIRST_VERSIONS[key]
        start, end, step = map(float, table["range"])
        values = np.array(table[key], dtype=float).reshape(-1, len(labels))
        nm: Array = start + step * np.arange(len(values), dtype=np.float64)
        if not len(nm) or abs(nm[-1] - end) > 1e-6:
            raise ValueError("the range does not fit the number of rows")
        return LabelledSpectra(labels, nm, values)
    spectra = table["spectral_data"]
    labels = tuple(map(str, spectra["index"]["main"]))
    rows = spectra["data"]["main"]
    wavelengths: Array = np.array([parse_float(nm) for nm in rows])
    values = np.array(list(rows.values()), dtype=float).reshape(len(rows), len(labels))
    return LabelledSpectra(labels, wavelengths, values)
