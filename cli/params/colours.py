"""Colours from arguments, files and standard input as linear RGB."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING

from uplift.common.errors import ColourError
from uplift.common.text import format_value, parse_float

from .text_lines import HINT, line_blocks

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.common.arrays import Array

HEX = re.compile(r"#?([0-9a-fA-F]{6})\Z")
SHORT_HEX = re.compile(r"#([0-9a-fA-F]{3})\Z")
SYNTAX = "write three numbers (R G B) or a hex colour such as '#cc3319'"


@dataclass(frozen=True)
class Colour:
    """Three numbers, and whether they are encoded 8-bit codes."""

    numbers: tuple[float, ...]
    encoded: bool


def from_arguments(words: Sequence[str], sensor: Sensor, *, encoded: bool, space: ImageSpace | None = None) -> Array:
    """Parse one colour, 'R G B', 'R,G,B' or '#rrggbb', into linear RGB (1, 3) of the sensor. Raises `ColourError`."""
    parts = [part for word in words for part in re.split(r"[,\s]+", word) if part]
    colour = _parse(parts)
    if colour is None or len(parts) > 3:
        raise _unreadable(parts)
    return _linear([colour], sensor, encoded=encoded, space=space)


def from_table(
    file: IO[bytes],
    name: str,
    sensor: Sensor,
    *,
    encoded: bool,
    bounded: bool,
    space: ImageSpace | None = None,
) -> Iterator[Array]:
    """Parse lines of 'r,g,b' or hex colours into blocks of linear RGB (n, 3), as the lines come.

    A first line without numbers is a header. Further columns are ignored. Linear RGB must lie in [0, 1] if ``bounded``.
    Raises `ColourError` with the line.
    """
    empty = True
    for lines in line_blocks(file, name):
        colours = {line: _parse_row(row, name, line) for line, row in _rows(lines, name)}
        for line, colour in colours.items():
            _check_range(colour, name, line, encoded=encoded or colour.encoded, bounded=bounded)
        if colours:
            empty = False
            yield _linear(list(colours.values()), sensor, encoded=encoded, space=space)
    if empty:
        raise ColourError("has no colours", code="no-colours", path=name, hint="give lines of r,g,b or of hex colours")


def _check_range(colour: Colour, name: str, line: int, *, encoded: bool, bounded: bool) -> None:
    """Check the range as the cube does, but report the line."""
    from uplift.colorimetry.sensor import SLACK

    values = "(" + ", ".join(f"{number:g}" for number in colour.numbers) + ")"
    if encoded:
        if not all(0 <= number <= 255 for number in colour.numbers):
            problem = f"8-bit codes must be in [0, 255], got {values}"
            raise ColourError(problem, code="invalid-codes", path=name, line=line)
    elif bounded:
        if not all(-SLACK <= number <= 1 + SLACK for number in colour.numbers):
            problem = f"linear RGB must be in [0, 1], got {values}"
            raise ColourError(problem, code="rgb-out-of-gamut", path=name, line=line)
    elif not all(map(math.isfinite, colour.numbers)):
        raise ColourError(f"{values} is not finite", code="rgb-not-finite", path=name, line=line, hint=SYNTAX)


def _rows(lines: Iterable[tuple[int, str]], name: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line number and the cells that are not empty, of all rows but the header."""
    for line, text in lines:
        try:
            cells = re.split(r"[;\t ]+", text.strip()) if "," not in text else next(csv.reader([text]))
        except csv.Error as error:
            raise ColourError(str(error), code="invalid-csv", path=name, line=line, hint=HINT) from error
        row = [cell.strip() for cell in cells if cell.strip()]
        if row and not (line == 1 and _is_header(row)):
            yield line, row


def _is_header(row: list[str]) -> bool:
    return _hex(row[0]) is None and not any(_number(cell) is not None for cell in row)


def _parse_row(row: list[str], name: str, line: int) -> Colour:
    """Parse the first columns of a row: a hex colour with '#', or a bare one alone, or three numbers."""
    colour = _parse(row[:1] if row[0].startswith("#") else row)
    if colour is None:
        raise _unreadable(row, path=name, line=line)
    return colour


def _parse(parts: Sequence[str]) -> Colour | None:
    """Parse one hex colour, or the first three of several numbers."""
    digits = _hex(parts[0]) if len(parts) == 1 else None
    if digits is not None:
        return Colour(tuple(int(digits[i : i + 2], 16) for i in (0, 2, 4)), encoded=True)
    numbers = [number for part in parts[:3] if (number := _number(part)) is not None]
    return Colour(tuple(numbers), encoded=False) if len(numbers) == 3 else None


def _unreadable(parts: Sequence[str], *, path: str | None = None, line: int | None = None) -> ColourError:
    problem = f"{format_value(' '.join(parts[:4]))} is not a colour"
    return ColourError(problem, code="invalid-colour", path=path, line=line, hint=SYNTAX)


def _hex(word: str) -> str | None:
    if short := SHORT_HEX.match(word):
        return "".join(2 * digit for digit in short[1])
    match = HEX.match(word)
    return match[1] if match else None


def _number(word: str) -> float | None:
    try:
        return parse_float(word)
    except ValueError:
        return None


def _linear(colours: list[Colour], sensor: Sensor, *, encoded: bool, space: ImageSpace | None) -> Array:
    """Decode hex colours, and with ``encoded`` all others, and convert colours of another space to the sensor's."""
    import numpy as np

    from uplift.lookup.validation import decode_codes

    values = np.array([colour.numbers for colour in colours], dtype=float)
    mask = np.array([encoded or colour.encoded for colour in colours])
    if space is None or space.decode is None:
        values[mask] = decode_codes(sensor, values[mask])
    else:
        values[mask] = space.decode(values[mask] / 255)
        if space.floats_are_codes:
            values[~mask] = space.decode(values[~mask])
    matrix = None if space is None else space.matrix_to(sensor)
    return values if matrix is None else np.asarray(values @ matrix.T)
