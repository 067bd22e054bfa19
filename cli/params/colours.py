"""Colours from arguments, files and standard input → linear RGB (n, 3)."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Sequence
from typing import IO, TYPE_CHECKING

from uplift.common.errors import ColourError

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Cube

HEX = re.compile(r"#?([0-9a-fA-F]{6})\Z")
SHORT_HEX = re.compile(r"#([0-9a-fA-F]{3})\Z")
SHOWN = 80
"""Characters that a message quotes."""
REMEDY = "write three numbers (R G B) or a hex colour such as '#cc3319'"


def from_arguments(words: Sequence[str], cube: Cube, *, codes: bool) -> Array:
    """One colour (1, 3) from 'R G B', 'R,G,B' or '#rrggbb'. Raises `ColourError`."""
    parts = [part for word in words for part in re.split(r"[,\s]+", word) if part]
    return _linear([_parse(parts, "")], cube, codes=codes)


def from_table(file: IO[str], name: str, cube: Cube, *, codes: bool, bounded: bool) -> Array:
    """Colours (n, 3) from lines of 'r,g,b' or hex; a first line without numbers is a header.

    Further columns are left alone. Linear numbers lie in [0, 1] if they are ``bounded``, else anywhere. Raises
    `ColourError` with the line.
    """
    colours = {line: _parse(row, f"{name}:{line}: ") for line, row in _rows(file, name)}
    if not colours:
        raise ColourError(f"{name}: no colours in it", hint="give lines of r,g,b or of hex colours")
    for line, (is_hex, numbers) in colours.items():
        _check_range(numbers, name, line, codes=is_hex or codes, bounded=bounded)
    return _linear(list(colours.values()), cube, codes=codes)


def _check_range(numbers: tuple[float, ...], name: str, line: int, *, codes: bool, bounded: bool) -> None:
    """As the cube checks them, but with the line."""
    values = "(" + ", ".join(f"{number:g}" for number in numbers) + ")"
    if codes:
        if not all(0 <= number <= 255 for number in numbers):
            hint = "leave out --8bit for linear floats"
            raise ColourError(f"{values} lies outside 0 to 255", path=name, line=line, hint=hint)
        return
    if bounded:
        from uplift.colorimetry.sensor import SLACK

        if not all(-SLACK <= number <= 1 + SLACK for number in numbers):
            hint = "move it with --out-of-gamut, or use --8bit for codes"
            raise ColourError(f"{values} lies outside [0, 1]", path=name, line=line, hint=hint)
    elif not all(map(math.isfinite, numbers)):
        raise ColourError(f"{values} is not finite", path=name, line=line, hint=REMEDY)


def _rows(file: IO[str], name: str) -> Iterable[tuple[int, list[str]]]:
    try:
        for line, text in enumerate(file, 1):
            cells = re.split(r"[;\t ]+", text.strip()) if "," not in text else next(csv.reader([text]))
            row = [cell.strip() for cell in cells if cell.strip()]
            if row and not (line == 1 and _is_header(row)):
                yield line, row
    except UnicodeDecodeError as error:
        raise ColourError(f"{name}: is not text", hint="give a CSV file of colours") from error
    except csv.Error as error:
        raise ColourError(str(error), path=name, line=line, hint="give a CSV file of colours") from error


def _is_header(row: list[str]) -> bool:
    return _hex(row[0]) is None and not any(_number(cell) is not None for cell in row)


def _parse(parts: Sequence[str], place: str) -> tuple[bool, tuple[float, ...]]:
    """Whether the colour is given in codes, and its three numbers."""
    digits = _hex(parts[0]) if parts else None
    if digits is not None and (len(parts) == 1 or (place and parts[0].startswith("#"))):
        return True, tuple(int(digits[i : i + 2], 16) for i in (0, 2, 4))
    numbers = [_number(part) for part in parts[:3]]
    if len(numbers) < 3 or None in numbers or (not place and len(parts) > 3):
        raise ColourError(f"{place}'{' '.join(parts)[:SHOWN]}' is no colour", hint=REMEDY)
    return False, tuple(number for number in numbers if number is not None)


def _hex(word: str) -> str | None:
    if short := SHORT_HEX.match(word):
        return "".join(2 * digit for digit in short[1])
    found = HEX.match(word)
    return found[1] if found else None


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None


def _linear(colours: list[tuple[bool, tuple[float, ...]]], cube: Cube, *, codes: bool) -> Array:
    """Hex colours and, with ``codes``, all others decoded as the cube's space has it."""
    import numpy as np

    values = np.array([numbers for _, numbers in colours], dtype=float)
    encoded = np.array([is_hex or codes for is_hex, _ in colours])
    values[encoded] = cube.decode(values[encoded])
    return values
