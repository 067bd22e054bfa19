"""Reflectances as CSV: a row per sample under a row of wavelengths, or the transpose of that."""

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
from uplift.atlas.document import Document, SourceLocation, nanometres, number, without_unit
from uplift.common.errors import OutputError, UpliftWarning

DELIMITERS = ",;\t"
NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"
LAYOUT = "write a header row of wavelengths in nm and a row per sample, or the transpose of that"


class Cell(NamedTuple):
    """A cell and the line it stands on."""

    text: str
    line: int


Row = tuple[Cell, ...]


def read(document: Document) -> Atlas:
    """All samples of a table; values in percent are recognised and scaled, with an `UpliftWarning`.

    Raises
    ------
    AtlasError : no table of reflectances, or a cell that is no number, with line, entry and hint.
    """
    header, *samples = _oriented(_rows(document), SourceLocation(document.path))
    place = SourceLocation(document.path, header[0].line)
    wavelengths = [nanometres(cell.text, place.at(cell.line), "wavelength") for cell in header[1:]]
    values = [_values(row, document.path) for row in samples]
    scale = _scale(samples, values, document.path)
    entries = [
        Entry(
            row[0].text, np.array(wavelengths), np.array(line) / scale, path=document.path, line=row[0].line
        )
        for row, line in zip(samples, values, strict=True)
    ]
    return Atlas(tuple(entries), sources=(Source(document.name, document.digest),))


def text(spectra: Atlas) -> str:
    """A row per sample; wavelengths and values are read back to the last bit.

    Raises
    ------
    OutputError : the entries are sampled at different wavelengths.
    """
    first = spectra.entries[0]
    for entry in spectra.entries:
        if not np.array_equal(entry.wavelengths, first.wavelengths):
            problem = f"entries '{first.name}' and '{entry.name}' are sampled at different wavelengths"
            raise OutputError(problem, hint="write atlas text, which keeps each sampling, or separate tables")
    out = io.StringIO()
    writer = csv.writer(out, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
    writer.writerow(["name", *first.wavelengths.tolist()])
    writer.writerows([entry.name, *entry.values.tolist()] for entry in spectra.entries)
    return out.getvalue()


def _rows(document: Document) -> list[Row]:
    """Rows that are not blank, all of one width."""
    place = SourceLocation(document.path)
    delimiter = _delimiter(document)
    try:
        rows = list(_split(document, delimiter))
    except csv.Error as error:
        raise place.error(f"no readable table: {error}", LAYOUT) from None
    if len(rows) < 2:
        raise place.at(1).error(NO_TABLE, LAYOUT)
    for row in rows:
        if len(row) != len(rows[0]):
            problem = f"{len(row)} cells, the header row has {len(rows[0])}"
            raise place.at(row[0].line).error(problem, "fill in the missing cells or remove the row")
    return rows


def _split(document: Document, delimiter: str) -> Iterator[Row]:
    line = 1
    reader = csv.reader(io.StringIO(document.text, newline=""), delimiter=delimiter)
    for cells in reader:
        while cells and not cells[-1].strip():  # spreadsheets pad rows
            cells.pop()
        if cells:
            yield tuple(Cell(_point(cell.strip(), delimiter), line) for cell in cells)
        line = reader.line_num + 1


def _point(cell: str, delimiter: str) -> str:
    """A decimal comma becomes a point where the comma separates nothing."""
    pointed = cell.replace(",", ".")
    return pointed if delimiter != "," and _is_number(pointed) else cell


def _delimiter(document: Document) -> str:
    """The separator that finds most numbers in the first two rows."""

    def numbers(delimiter: str) -> int:
        try:
            rows = list(itertools.islice(_split(document, delimiter), 2))
        except csv.Error:
            return 0
        return sum(_is_number(cell.text) for row in rows for cell in row)

    return max(DELIMITERS, key=numbers)


def _oriented(rows: list[Row], place: SourceLocation) -> list[Row]:
    """The table turned so that the wavelengths are its first row."""
    columns = list(zip(*rows, strict=True))
    tables = [table for table in (rows, columns) if _numeric(table[0][1:])]
    if len(columns) < 2 or not tables:
        raise place.at(rows[0][0].line).error(NO_TABLE, LAYOUT)
    if _is_number(rows[0][0].text):
        raise place.at(rows[0][0].line).error("the header row is missing", LAYOUT)
    return next((table for table in tables if _covers(table[0][1:])), tables[0])


def _numeric(cells: Sequence[Cell]) -> bool:
    return all(_is_number(without_unit(cell.text)) for cell in cells)


def _covers(cells: Sequence[Cell]) -> bool:
    """Whether numbers may be wavelengths: names can be numbers too."""
    numbers = [float(without_unit(cell.text)) for cell in cells]
    return numbers[0] <= VISIBLE[0] + SLACK and numbers[-1] >= VISIBLE[1] - SLACK


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _values(row: Row, path: str) -> list[float]:
    name, *cells = row
    return [number(cell.text, SourceLocation(path, cell.line, name.text), "value") for cell in cells]


def _scale(samples: list[Row], values: list[list[float]], path: str) -> float:
    """1, or 100 where any value is too large for a reflectance in units of 1."""
    named = ((value, row[0].text) for row, line in zip(samples, values, strict=True) for value in line)
    large = [pair for pair in named if pair[0] > HIGHEST]
    if not large:
        return 1.0
    largest, name = max(large)
    message = f"{path}: values up to {largest:g} (entry '{name}'): read as percent, divided by 100"
    warnings.warn(message, UpliftWarning, stacklevel=4)
    return 100.0
