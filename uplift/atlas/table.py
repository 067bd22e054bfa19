"""Reflectances as CSV: a row per entry below a row of wavelengths, or the transpose."""

from __future__ import annotations

import csv
import io
import itertools
import warnings
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Source
from uplift.atlas.checks import HIGHEST, SLACK, VISIBLE
from uplift.atlas.document import Document, SourceLocation, parse_nanometres, parse_number, without_unit
from uplift.common.csv import csv_text, plain_cell
from uplift.common.errors import OutputError, UpliftWarning
from uplift.common.number_text import parse_float

DELIMITERS = ",;\t"
NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"
LAYOUT = "write a header row of wavelengths in nm and a row per entry, or the transpose"


class Cell(NamedTuple):
    """Text of a cell, and its line."""

    text: str
    line: int


Row = tuple[Cell, ...]


def read(document: Document) -> Atlas:
    """Read the entries of a table; values in percent are recognised and scaled, with a warning.

    Raises
    ------
    AtlasError
        The text is not a table of reflectances, or a cell is not a number; with line, entry and hint.
    """
    header, *rows = _orient(_rows(document), SourceLocation(document.path))
    location = SourceLocation(document.path, header[0].line)
    wavelengths = [parse_nanometres(cell.text, location.at(cell.line), "wavelength") for cell in header[1:]]
    values = [_values(row, document.path) for row in rows]
    scale = _scale(rows, values, document.path)
    entries = [
        Entry(
            row[0].text, np.array(wavelengths), np.array(line) / scale, path=document.path, line=row[0].line
        )
        for row, line in zip(rows, values, strict=True)
    ]
    return Atlas(tuple(entries), sources=(Source(document.name, document.digest),))


def text(atlas: Atlas) -> str:
    """Format a row per entry; `read` returns the same wavelengths and values, bit for bit.

    Raises
    ------
    OutputError
        The entries are sampled at different wavelengths.
    """
    first = atlas[0]
    for entry in atlas:
        if not np.array_equal(entry.wavelengths, first.wavelengths):
            problem = f"entries '{first.name}' and '{entry.name}' are sampled at different wavelengths"
            raise OutputError(
                problem,
                code="different-samplings",
                hint="write atlas text, which keeps each sampling, or separate tables",
            )
    rows = ([entry.name, *entry.values.tolist()] for entry in atlas)
    return csv_text(["name", *first.wavelengths.tolist()], rows, quote_text=True)


def _rows(document: Document) -> list[Row]:
    """Split a document into rows that are not blank, of equal width."""
    location = SourceLocation(document.path)
    delimiter = _delimiter(document)
    try:
        rows = list(_split(document, delimiter))
    except csv.Error as error:
        raise location.error(f"not a readable table: {error}", LAYOUT, code="not-a-table") from None
    if len(rows) < 2:
        raise location.at(1).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    for row in rows:
        if len(row) != len(rows[0]):
            problem = f"a row must have {len(rows[0])} cells like the header row, got {len(row)}"
            hint = "fill in the missing cells or remove the row"
            raise location.at(row[0].line).error(problem, hint, code="row-of-wrong-length")
    return rows


def _split(document: Document, delimiter: str) -> Iterator[Row]:
    line = 1
    reader = csv.reader(io.StringIO(document.text, newline=""), delimiter=delimiter)
    for cells in reader:
        while cells and not cells[-1].strip():  # spreadsheets pad rows
            cells.pop()
        if cells:
            plain = (plain_cell(cell.strip()) for cell in cells)
            yield tuple(Cell(_decimal_point(cell, delimiter), line) for cell in plain)
        line = reader.line_num + 1


def _decimal_point(cell: str, delimiter: str) -> str:
    """Replace a decimal comma by a point, unless the comma is the delimiter."""
    pointed = cell.replace(",", ".")
    return pointed if delimiter != "," and _is_number(pointed) else cell


def _delimiter(document: Document) -> str:
    """Return the delimiter that yields most numbers in the first two rows."""

    def numbers(delimiter: str) -> int:
        try:
            rows = list(itertools.islice(_split(document, delimiter), 2))
        except csv.Error:
            return 0
        return sum(_is_number(cell.text) for row in rows for cell in row)

    return max(DELIMITERS, key=numbers)


def _orient(rows: list[Row], location: SourceLocation) -> list[Row]:
    """Transpose the table if necessary, so that its first row contains the wavelengths."""
    columns = list(zip(*rows, strict=True))
    tables = [table for table in (rows, columns) if _numeric(table[0][1:])]
    if len(columns) < 2 or not tables:
        raise location.at(rows[0][0].line).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    if _is_number(rows[0][0].text):
        raise location.at(rows[0][0].line).error(
            "the header row is missing", LAYOUT, code="header-row-missing"
        )
    return next((table for table in tables if _covers(table[0][1:])), tables[0])


def _numeric(cells: Sequence[Cell]) -> bool:
    return all(_is_number(without_unit(cell.text)) for cell in cells)


def _covers(cells: Sequence[Cell]) -> bool:
    """Whether numbers cover the visible range, as wavelengths do and numeric names usually do not."""
    numbers = [parse_float(without_unit(cell.text)) for cell in cells]
    return numbers[0] <= VISIBLE[0] + SLACK and numbers[-1] >= VISIBLE[1] - SLACK


def _is_number(text: str) -> bool:
    try:
        parse_float(text)
    except ValueError:
        return False
    return True


def _values(row: Row, path: str) -> list[float]:
    name, *cells = row
    return [parse_number(cell.text, SourceLocation(path, cell.line, name.text), "value") for cell in cells]


def _scale(rows: list[Row], values: list[list[float]], path: str) -> float:
    """Return 100 if any value is too large for a reflectance in units of 1, else 1."""
    named = ((value, row[0].text) for row, line in zip(rows, values, strict=True) for value in line)
    large = [pair for pair in named if pair[0] > HIGHEST]
    if not large:
        return 1.0
    largest, name = max(large)
    problem = f"values up to {largest:g} are read as percent and divided by 100"
    warnings.warn(UpliftWarning(problem, code="values-in-percent", path=path, entry=name), stacklevel=4)
    return 100.0
