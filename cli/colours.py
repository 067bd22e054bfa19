"""Colours from arguments, files and standard input. All raise `ColourError`."""

from __future__ import annotations

import codecs
import io
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import IO, TYPE_CHECKING

import click

from uplift.common.errors import ColourError, UpliftWarning
from uplift.common.text import format_value
from uplift.extras.files.csv import (
    DELIMITERS,
    find_delimiter,
    parse_decimal,
    split_line,
)

from .inputs import find_input_space
from .output.diagnostics import warn

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.colour.spaces import ImageSpace

AMBIGUOUS = re.compile(r"(?:[01](?:,\d+)?,){2}[01](?:,\d+)?", re.ASCII)
"""Whole numbers between commas that may be three numbers from 0 to 1 with decimal
commas.
"""
RGBA = re.compile(r"[01](?:,[01]){3}")
TRIPLE = re.compile(r"[+-]?\d+(?:,\d+)?(?: [+-]?\d+(?:,\d+)?){2}", re.ASCII)
"""Three numbers, whole or with decimal commas."""
DECIMALS = (
    "write decimal points, or separate numbers with decimal commas by semicolons: "
    "'0,2;0,3;0,4'"
)
HEX = re.compile(r"#?([0-9a-fA-F]{6})|#([0-9a-fA-F]{3})")
_NUMBER = r"[+-]?+(?:[0-9]++\.?+[0-9]*+|\.[0-9]++)(?:[eE][+-]?+[0-9]++)?+"
PLAIN_LINES = re.compile(
    rf"(?:{_NUMBER}(, ?|[;\t ]){_NUMBER}\1{_NUMBER}\n)++|(?:#[0-9a-fA-F]{{6}}\n)++"
)
"""Lines of three numbers with decimal points, or of hex colours: parsed at once."""
SEPARATORS = str.maketrans(",;", "  ")
STATED_DELIMITER = re.compile(r"\s*\"?sep=.\"?\s*", re.IGNORECASE)
"""First line that states the delimiter to spreadsheets."""
SYNTAX = "write three numbers (R G B) or a hex colour such as '#cc3319'"
TABLE = "give a CSV file of colours"
CHUNK = 1 << 16
"""Bytes read at once. A pipe gives those that have arrived."""
MAX_LINE = 1 << 16
"""Characters of a line."""


Colour = tuple[list[float], bool]
"""Three numbers, or those of several colours, and whether they are encoded 8-bit codes.
"""


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
    space: ImageSpace | None = None

    @property
    def single(self) -> bool:
        """Whether there is one colour, and not a file of them."""
        return self.path is None and (
            self.xyz is not None or len(_parse_words(self.words)) == 1
        )

    def blocks(self, sensor: Sensor, *, bounded: bool = False) -> Iterable[Array]:
        """Return blocks of linear RGB (n, 3) from the words or the file, which must lie
        in [0, 1] if ``bounded``.
        """
        if self.path is not None:
            return self._read(self.path, sensor, bounded)
        colours = _parse_words(self.words)
        if self.encoded:
            _warn_of_fractions(colours)
        for word in self.words:
            self._check_commas(word)
        return [self._linear(colours, sensor)]

    def _read(self, path: str, sensor: Sensor, bounded: bool) -> Iterator[Array]:
        try:
            with click.open_file(path, "rb") as file:
                yield from self.parse_table(
                    file, "standard input" if path == "-" else path, sensor, bounded
                )
        except OSError as error:
            raise ColourError(
                f"cannot be read: {error.strerror}", path=path, hint=TABLE
            ) from error

    def parse_table(
        self, file: IO[bytes], name: str, sensor: Sensor, bounded: bool = False
    ) -> Iterator[Array]:
        """Parse lines of 'r,g,b' or hex colours into blocks of linear RGB (n, 3), as
        the lines come.

        Cells are separated by commas, semicolons, tabs or blanks, and numbers may have
        decimal commas. A first line without numbers is a header. Further columns are
        ignored.
        """
        empty = True
        width = None  # cells of the header, 0 without one
        for rows in _row_blocks(file, name):
            colours = list[Colour]()
            for line, text, row in rows:
                if not row:
                    colours.append(self._parse_plain(text, name, line, bounded))
                    width = width or 0
                    continue
                if width is None:
                    width = len(row) if _is_header(row) else 0
                    if width:
                        continue
                colour = _parse(row[:1] if row[0].startswith("#") else row)
                if colour is None:
                    raise _not_a_colour(text, name, line)
                if width != len(row):
                    self._check_commas(text, name, line)
                self._check_range(colour, text, name, line, bounded)
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

    def _check_commas(
        self, text: str, path: str | None = None, line: int | None = None
    ) -> None:
        if not self.encoded and _is_ambiguous(text):
            raise ColourError(
                f"{format_value(text)} may have decimal commas, or more than three "
                "numbers",
                code="ambiguous-numbers",
                path=path,
                line=line,
                hint=DECIMALS,
            )

    def _parse_plain(self, text: str, name: str, line: int, bounded: bool) -> Colour:
        """Parse `PLAIN_LINES`."""
        is_hex = text.startswith("#")
        if is_hex:
            numbers = list[float](bytes.fromhex(text.replace("#", "")))
        else:
            numbers = list(map(float, text.translate(SEPARATORS).split()))
        low, high = self._limits(is_hex, bounded)
        if not low <= min(numbers) <= max(numbers) <= high:
            for row, words in enumerate(text.splitlines()):
                colour = numbers[3 * row : 3 * row + 3], is_hex
                self._check_range(colour, words, name, line + row, bounded)
        return numbers, is_hex

    def _limits(self, is_hex: bool, bounded: bool) -> tuple[float, float]:
        from uplift.colorimetry.sensor import SLACK

        if self.encoded or is_hex:
            return 0, 255
        if bounded:
            return -SLACK, 1 + SLACK
        return -sys.float_info.max, sys.float_info.max

    def _check_range(
        self, colour: Colour, text: str, name: str, line: int, bounded: bool
    ) -> None:
        """Check the range as the cube does, but report the line."""
        numbers, encoded = colour
        low, high = self._limits(encoded, bounded)
        if all(low <= number <= high for number in numbers):
            return
        values = format_value(text)
        if self.encoded or encoded:
            problem = f"8-bit codes must be in [0, 255], got {values}"
            raise ColourError(problem, code="invalid-codes", path=name, line=line)
        if bounded:
            problem = f"linear RGB must be in [0, 1], got {values}"
            raise ColourError(problem, code="rgb-out-of-gamut", path=name, line=line)
        raise ColourError(f"{values} is not finite", path=name, line=line, hint=SYNTAX)

    def _linear(self, colours: list[Colour], sensor: Sensor) -> Array:
        """Decode codes, and convert colours of another space to the sensor's."""
        import numpy as np

        space = self.space
        values = np.array(list(chain.from_iterable(numbers for numbers, _ in colours)))
        values = values.astype(float).reshape(-1, 3)
        codes = [self.encoded or encoded for _, encoded in colours]
        mask = np.repeat(codes, [len(numbers) // 3 for numbers, _ in colours])
        if space is not None and space.decode is not None:
            values[mask] = space.decode(values[mask] / 255)
            if space.floats_are_codes:
                values[~mask] = space.decode(values[~mask])
        elif mask.any():
            from uplift.lookup.blocks import decode_codes

            values[mask] = decode_codes(sensor, values[mask])
        matrix = None if space is None else space.matrix_to(sensor)
        return values if matrix is None else np.asarray(values @ matrix.T)


def is_colour(text: str) -> bool:
    """Whether a text is a colour."""
    return HEX.fullmatch(text) is not None or _parse(text.split(",")) is not None


def find_colours(
    colour: tuple[str, ...],
    input_path: str | None,
    xyz: tuple[float, float, float] | None,
    xy: tuple[float, float] | None,
    luminance: float | None,
    encoded: bool,
    input_space: str | None,
) -> ColourSource:
    """Return the source that the values of `colour_sources` name. Raises click's error
    for none or several.
    """
    space = None if input_space is None else find_input_space(input_space)
    if colour == ("-",):
        colour = ()
        input_path = input_path or "-"
    if (xy is None) != (luminance is None) or (xyz is not None and xy is not None):
        raise click.UsageError(
            "--xy X Y and --luminance Y require each other, and --xyz is an "
            "alternative."
        )
    if xy is not None and luminance is not None:
        x, y = xy
        if not y > 0:
            raise ColourError(
                f"y of a chromaticity must be positive, got {y:g}",
                hint="give CIE x and y",
            )
        xyz = x * luminance / y, luminance, (1 - x - y) * luminance / y
    if (xyz is not None) + bool(colour) + (input_path is not None) != 1:
        raise click.UsageError("Give colours, --input FILE, '-', --xyz or --xy.")
    return ColourSource(colour, input_path, xyz, encoded, space)


def _row_blocks(
    file: IO[bytes], name: str
) -> Iterator[list[tuple[int, str, list[str]]]]:
    """Yield line numbers, texts and cells in blocks, each as soon as it can be read: a
    stream may never end. `PLAIN_LINES` have one text and no cells.
    """
    decoder = io.IncrementalNewlineDecoder(
        codecs.getincrementaldecoder("utf-8-sig")(), translate=True
    )
    read = getattr(file, "read1", file.read)
    line = 1
    unread = ""
    at_end = False
    while not at_end:
        chunk = read(CHUNK)
        at_end = not chunk
        try:
            unread += decoder.decode(chunk, final=at_end)
        except UnicodeDecodeError as error:
            raise ColourError("is not a text file", path=name, hint=TABLE) from error
        for number, text in enumerate(unread.split("\n"), line):
            if len(text) > MAX_LINE:
                raise ColourError(
                    f"lines must not exceed {MAX_LINE:,} characters",
                    path=name,
                    line=number,
                    hint=TABLE,
                )
        if at_end:
            unread += "\n"
        rows = []
        start = 0
        while end := unread.find("\n", start) + 1:
            plain = PLAIN_LINES.match(unread, start)
            if plain:
                end = plain.end()
                rows.append((line, plain[0], list[str]()))
            elif row := _cells(unread[start : end - 1], name, line):
                rows.append((line, unread[start:end].strip(), row))
            line += unread.count("\n", start, end)
            start = end
        unread = unread[start:]
        yield rows


def _cells(text: str, name: str, line: int) -> list[str]:
    """Return the cells of a line; none if it is empty or states the delimiter."""
    if not text.strip("".join(DELIMITERS)) or (
        line == 1 and STATED_DELIMITER.match(text)
    ):
        return []
    try:
        return split_line(text, find_delimiter([text]))
    except ValueError as error:
        raise ColourError(str(error), path=name, line=line, hint=TABLE) from error


def _is_header(row: Sequence[str]) -> bool:
    """Whether the cells of a line are neither numbers nor like a hex colour."""
    return (
        re.match(r"#\w", row[0]) is None
        and _parse(row[:1]) is None
        and all(_number(cell) is None for cell in row)
    )


def _is_ambiguous(text: str) -> bool:
    """Whether a text between commas may be three numbers with decimal commas; not red,
    green, blue and alpha.
    """
    text = re.sub(r"\s", "", text)
    return (
        text.count(",") > 2
        and RGBA.fullmatch(text) is None
        and AMBIGUOUS.fullmatch(text) is not None
    )


def _parse(cells: Sequence[str]) -> Colour | None:
    """Parse one hex colour, or the first three of several numbers."""
    if len(cells) == 1 and (match := HEX.fullmatch(cells[0])):
        digits = match[1] or "".join(2 * digit for digit in match[2])
        return list(bytes.fromhex(digits)), True
    if len(cells) < 3:
        return None
    try:
        return list(map(parse_decimal, cells[:3])), False
    except ValueError:
        return None


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
    colours: list[Colour] = []
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
        warn([UpliftWarning(problem, hint=hint)])


def _number(word: str) -> float | None:
    try:
        return parse_decimal(word)
    except ValueError:
        return None


def _not_a_colour(
    text: str, path: str | None = None, line: int | None = None
) -> ColourError:
    return ColourError(
        f"{format_value(text)} is not a colour", path=path, line=line, hint=SYNTAX
    )
