"""Colours in words, files and standard input. All raise `ColourError`."""

import codecs
import io
import re
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from itertools import chain
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from uplift.colorimetry.sensor import SLACK, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, UpliftWarning
from uplift.common.text import format_value

if TYPE_CHECKING:
    from uplift.extras.colour.spaces import ImageSpace
from uplift.extras.files.csv import (
    DELIMITERS,
    find_delimiter,
    is_decimal,
    parse_decimal,
    split_line,
)

AMBIGUOUS = re.compile(r"(?:[01](?:,\d+)?,){2}[01](?:,\d+)?", re.ASCII)
"""Whole numbers between commas that may be three numbers from 0 to 1 with decimal
commas.
"""
RGBA = re.compile(r"[01](?:,[01]){3}")
TRIPLE = re.compile(r"[+-]?\d+(?:,\d+)?(?: [+-]?\d+(?:,\d+)?){2}", re.ASCII)
"""Three numbers, whole or with decimal commas."""
HEX = re.compile(r"#?([0-9a-fA-F]{6})|#([0-9a-fA-F]{3})")
_NUMBER = r"([+-]?+(?:[0-9]++\.?+[0-9]*+|\.[0-9]++)(?:[eE][+-]?+[0-9]++)?+)"
PLAIN = re.compile(rf"{_NUMBER}(, ?|[;\t ]){_NUMBER}\2{_NUMBER}")
"""Line of three numbers with decimal points, which is parsed without a search for the
delimiter.
"""
STATED_DELIMITER = re.compile(r"\s*\"?sep=.\"?\s*", re.IGNORECASE)
"""First line that states the delimiter to spreadsheets."""
DECIMALS = (
    "write decimal points, or separate numbers with decimal commas by semicolons: "
    "'0,2;0,3;0,4'"
)
SYNTAX = "write three numbers (R G B) or a hex colour such as '#cc3319'"
TABLE = "give a CSV file of colours"
CHUNK = 1 << 16
"""Bytes read at once. A pipe gives those that have arrived."""
MAX_LINE = 1 << 16
"""Characters of a line."""
Colour = tuple[Sequence[float], bool]
"""Three numbers, and whether they are the 8-bit codes of a hex colour."""


@dataclass(frozen=True)
class ColourSource:
    """Colours in words, or in the file of a ``path``, '-' for standard input, or one by
    XYZ.

    Numbers are codes from 0 to 255 if ``encoded``, else linear RGB. Colours are in
    ``space``, or in that of the sensor whose linear RGB they are converted to.
    """

    words: tuple[str, ...] = ()
    path: str | None = None
    xyz: tuple[float, float, float] | None = None
    encoded: bool = False
    space: "ImageSpace | None" = None

    @property
    def single(self) -> bool:
        """Whether there is one colour, and not a file of them."""
        return self.path is None and (
            self.xyz is not None or len(_parse_words(self.words)) == 1
        )

    def blocks(self, sensor: Sensor, *, bounded: bool = False) -> Iterator[Array]:
        """Yield blocks of linear RGB (n, 3) from the words or the file, which must lie
        in [0, 1] if ``bounded``.
        """
        if self.path is None:
            colours = _parse_words(self.words)
            if self.encoded:
                _warn_of_fractions(colours)
            for word in self.words:
                self._check_commas(word)
            yield self._linear(colours, sensor)
            return
        name = "standard input" if self.path == "-" else self.path
        try:
            with _open(self.path) as file:
                yield from self.parse_table(file, name, sensor, bounded)
        except OSError as error:
            problem = f"cannot be read: {error.strerror}"
            raise ColourError(problem, path=self.path, hint=TABLE) from error

    def parse_table(
        self, file: IO[bytes], name: str, sensor: Sensor, bounded: bool = False
    ) -> Iterator[Array]:
        """Parse lines of 'r,g,b' or hex colours into blocks of linear RGB (n, 3), as
        the lines come.

        Cells are separated by commas, semicolons, tabs or blanks, and numbers may have
        decimal commas. A first line without numbers is a header. Further columns are
        ignored.
        """
        numbers = (
            (-SLACK, 1 + SLACK)
            if bounded
            else (-sys.float_info.max, sys.float_info.max)
        )
        empty = True
        header: int | None = None  # number of its cells, 0 without one
        for lines in _line_blocks(file, name):
            colours = []
            for line, text in lines:
                place: dict[str, Any] = {"path": name, "line": line}
                colour = _parse_plain(text)
                if colour is None:
                    row = _cells(text, **place)
                    if not row:
                        continue
                    if header is None and _is_header(row):
                        header = len(row)
                        continue
                    colour = _parse(row[:1] if row[0].startswith("#") else row)
                    if colour is None:
                        raise _not_a_colour(text, **place)
                    if len(row) != header:
                        self._check_commas(text, **place)
                header = header or 0
                is_code = self.encoded or colour[1]
                low, high = (0, 255) if is_code else numbers
                if not all(low <= number <= high for number in colour[0]):
                    raise _out_of_range(text, is_code, bounded, **place)
                colours.append(colour)
            if colours:
                empty = False
                yield self._linear(colours, sensor)
        if empty:
            raise ColourError(
                "has no colours",
                path=name,
                hint="give lines of r,g,b or of hex colours",
            )

    def _check_commas(self, text: str, **place: Any) -> None:
        """Raise an error for a text between commas that may be three numbers with
        decimal commas; not red, green, blue and alpha.
        """
        cells = re.sub(r"\s", "", text)
        if (
            not self.encoded
            and cells.count(",") > 2
            and RGBA.fullmatch(cells) is None
            and AMBIGUOUS.fullmatch(cells)
        ):
            raise ColourError(
                f"{format_value(text)} may have decimal commas, or more than three "
                "numbers",
                code="ambiguous-numbers",
                hint=DECIMALS,
                **place,
            )

    def _linear(self, colours: Sequence[Colour], sensor: Sensor) -> Array:
        """Decode codes, and convert colours of another space to the sensor's."""
        space = self.space
        values = np.array([numbers for numbers, _ in colours], dtype=float)
        codes = np.array([self.encoded or is_hex for _, is_hex in colours])
        if space is not None and space.decode is not None:
            values[codes] = space.decode(values[codes] / 255)
            if space.floats_are_codes:
                values[~codes] = space.decode(values[~codes])
        elif codes.any():
            from uplift.lookup.blocks import decode_codes

            values[codes] = decode_codes(sensor, values[codes])
        matrix = None if space is None else space.matrix_to(sensor)
        return values if matrix is None else np.asarray(values @ matrix.T)


def is_colour(text: str) -> bool:
    """Whether a text is a colour."""
    return _parse(text.split(",")) is not None


def _open(path: str) -> AbstractContextManager[IO[bytes]]:
    return nullcontext(sys.stdin.buffer) if path == "-" else open(path, "rb")


def _line_blocks(file: IO[bytes], name: str) -> Iterator[list[tuple[int, str]]]:
    """Yield numbered lines in blocks, each as soon as it can be read: a stream may
    never end.
    """
    decoder = io.IncrementalNewlineDecoder(
        codecs.getincrementaldecoder("utf-8-sig")(), translate=True
    )
    read = getattr(file, "read1", file.read)
    number = 1
    unread = ""
    at_end = False
    while not at_end:
        chunk = read(CHUNK)
        at_end = not chunk
        try:
            unread += decoder.decode(chunk, final=at_end)
        except UnicodeDecodeError as error:
            raise ColourError("is not a text file", path=name, hint=TABLE) from error
        lines = list(enumerate(unread.split("\n"), number))
        for line, text in lines:
            if len(text) > MAX_LINE:
                problem = f"lines must not exceed {MAX_LINE:,} characters"
                raise ColourError(problem, path=name, line=line, hint=TABLE)
        if not at_end:
            number, unread = lines.pop()
        yield lines


def _cells(text: str, path: str, line: int) -> list[str]:
    """Return the cells of a line; none if it is empty or states the delimiter."""
    if not text.strip("".join(DELIMITERS)) or (
        line == 1 and STATED_DELIMITER.match(text)
    ):
        return []
    try:
        return split_line(text, find_delimiter([text]))
    except ValueError as error:
        raise ColourError(str(error), path=path, line=line, hint=TABLE) from error


def _is_header(row: Sequence[str]) -> bool:
    """Whether the cells of a line are neither numbers nor like a hex colour."""
    return (
        re.match(r"#\w", row[0]) is None
        and _parse(row[:1]) is None
        and not any(map(is_decimal, row))
    )


def _parse_plain(text: str) -> Colour | None:
    match = PLAIN.fullmatch(text)
    if match is None:
        return None
    red, _, green, blue = match.groups()
    return (float(red), float(green), float(blue)), False


def _parse(cells: Sequence[str]) -> Colour | None:
    """Parse one hex colour, or the first three of several numbers."""
    if len(cells) == 1 and (match := HEX.fullmatch(cells[0])):
        digits = match[1] or "".join(2 * digit for digit in match[2])
        return tuple(bytes.fromhex(digits)), True
    if len(cells) < 3 or not all(map(is_decimal, cells[:3])):
        return None
    return tuple(map(parse_decimal, cells[:3])), False


def _parse_words(words: Sequence[str]) -> list[Colour]:
    """Parse colours 'R G B', 'R,G,B' and '#rrggbb', one after the other.

    Three numbers of which one has a decimal comma, such as '0,2 0,3 1' or '0,2;0,3;1',
    are a colour too.
    """
    text = " ".join(words)
    unread = text.replace(";", " ").split()
    cells = list[str]()
    while unread:
        triple = " ".join(unread[:3])
        if "," in triple and TRIPLE.fullmatch(triple):
            cells += unread[:3]
            unread = unread[3:]
        else:
            cells += filter(None, unread[0].split(","))
            unread = unread[1:]
    colours = list[Colour]()
    while cells:
        length = 3 if _parse(cells[:3]) else 1
        colour = _parse(cells[:length])
        if colour is None:
            raise _not_a_colour(" ".join(cells[:4]) if colours else text)
        colours.append(colour)
        cells = cells[length:]
    if words and not colours:
        raise _not_a_colour(text)
    return colours


def _warn_of_fractions(colours: Sequence[Colour]) -> None:
    """Warn of codes that look like numbers from 0 to 1."""
    decimals = (numbers for numbers, is_hex in colours if not is_hex)
    values = list(chain.from_iterable(decimals))
    if values and max(values) <= 1 and any(value % 1 for value in values):
        codes = " ".join(f"{255 * value:.0f}" for value in values[:3])
        problem = f"8-bit codes run from 0 to 255, got numbers up to {max(values):g}"
        hint = f"for encoded numbers from 0 to 1 give 255 times as much: {codes}"
        warnings.warn(UpliftWarning(problem, hint=hint), stacklevel=2)


def _not_a_colour(text: str, **place: Any) -> ColourError:
    problem = f"{format_value(text.strip())} is not a colour"
    return ColourError(problem, hint=SYNTAX, **place)


def _out_of_range(text: str, is_code: bool, bounded: bool, **place: Any) -> ColourError:
    """Return the error that the cube raises, with the line."""
    values = format_value(text.strip())
    if is_code:
        problem = f"8-bit codes must be in [0, 255], got {values}"
        return ColourError(problem, code="invalid-codes", **place)
    if bounded:
        problem = f"linear RGB must be in [0, 1], got {values}"
        return ColourError(problem, code="rgb-out-of-gamut", **place)
    return ColourError(f"{values} is not finite", hint=SYNTAX, **place)
