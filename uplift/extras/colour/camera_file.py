"""Files of spectral sensitivities of cameras: tables, and JSON of rawtoaces."""

from pathlib import Path

import numpy as np

from uplift.colorimetry.camera import LAYOUT, Camera
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OptionError
from uplift.common.files import read_bytes
from uplift.common.text import format_value
from uplift.extras.colour.spectra_json import RGB, is_json, read_spectra
from uplift.extras.files.csv import (
    find_delimiter,
    is_decimal,
    parse_decimal,
    split_line,
)

MAX_BYTES = 1_000_000


def read_camera(path: StrPath) -> Camera:
    """Read the sensitivities of a file, whose name without the suffix is that of the
    camera.

    Rows of a table have a wavelength in nm, red, green and blue, separated by commas,
    semicolons, tabs or blanks, with decimal points or commas, in ascending or
    descending order. Rows before them with fewer than two numbers are headers; lines
    that begin with ``#`` are comments. JSON (``.json``) is that of rawtoaces. Raises
    `OptionError` for anything else.
    """
    if is_json(path):
        spectra = read_spectra(path, RGB, OptionError)
        wavelengths = spectra.wavelengths
        sensitivities = spectra.values
    else:
        table = _read_table(path)
        wavelengths = table[:, 0]
        sensitivities = table[:, 1:]
    name = Path(path).stem.encode(errors="backslashreplace").decode()
    try:
        return Camera(name, wavelengths, sensitivities)
    except OptionError as error:
        raise OptionError(
            error.problem, code=error.code, path=path, hint=error.hint
        ) from error


def _read_table(path: StrPath) -> Array:
    """Read rows (N, 4) of a wavelength and three sensitivities, in ascending order if
    they descend.
    """
    data = read_bytes(path, OptionError, limit=MAX_BYTES, hint=LAYOUT)
    encoding = "utf-16" if data.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig"
    lines = data.decode(encoding, errors="replace").splitlines()
    table: list[list[float]] = []
    try:
        delimiter = find_delimiter(lines)
        rows = [split_line(line, delimiter) for line in lines]
    except ValueError as error:
        raise OptionError(
            f"is not a readable table: {error}", path=path, hint=LAYOUT
        ) from error
    for line, cells in enumerate(rows, 1):
        is_header = not table and sum(map(is_decimal, cells)) < 2
        if not cells or cells[0].startswith("#") or is_header:
            continue
        try:
            wavelength, red, green, blue = map(parse_decimal, cells)
        except ValueError as error:
            problem = (
                f"a row must have four numbers, got {format_value(lines[line - 1])}"
            )
            raise OptionError(problem, path=path, line=line, hint=LAYOUT) from error
        table.append([wavelength, red, green, blue])
    numbers = np.array(table).reshape(-1, 4)
    descends = len(numbers) > 1 and (np.diff(numbers[:, 0]) < 0).all()
    return numbers[::-1] if descends else numbers
