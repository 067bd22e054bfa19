"""Reflectances as delimited text: a row per entry below a row of wavelengths, or the transpose."""

from __future__ import annotations

import csv
import io
import itertools
import re
from collections.abc import Iterator

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.document import Document, SourceLocation
from uplift.atlas.formats.grid import LAYOUT, NO_TABLE, Cell, Row, is_number, read_grid, trimmed, wavelength
from uplift.atlas.measurements import Measurements, Spectrum
from uplift.common.csv import csv_text, plain_cell
from uplift.common.errors import OutputError
from uplift.common.text import parse_float

DELIMITERS = ",;\t"
BLANKS = " "
"""Delimiter of a table whose cells are separated by any number of blanks."""
SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)
"""First line of a table that states its delimiter to spreadsheets."""
SAMPLE_ROWS = 200
"""Rows by which the delimiter is chosen."""


def read(document: Document) -> Measurements:
    """Read the entries of a table: a row or a column per spectrum, or the two columns of a single spectrum.

    Lines that begin with ``#`` are comments. Rows before the table are its preamble.
    """
    comments = "\n".join(line for line in document.lines if line.lstrip().startswith("#"))
    rows = _rows(document)
    if all(len(row) == 2 and all(is_number(cell.text) for cell in row) for row in rows):
        nm, values = ([parse_float(row[column].text) for row in rows] for column in (0, 1))
        spectrum = Spectrum(document.stem, nm, values, rows[0][0].line)
        return Measurements((spectrum,), notes=("layout: wavelength and value", "name: that of the file"))
    return read_grid(rows, document.path, comments)


def text(atlas: Atlas) -> str:
    """Format a row per entry; `read` returns the same wavelengths and values, bit for bit."""
    first = atlas[0]
    for entry in atlas:
        if not np.array_equal(entry.wavelengths, first.wavelengths):
            problem = f"entries '{first.name}' and '{entry.name}' are sampled at different wavelengths"
            raise OutputError(problem, hint="write atlas text, which keeps each sampling, or separate tables")
    rows = ([entry.name, *entry.values.tolist()] for entry in atlas)
    return csv_text(["name", *first.wavelengths.tolist()], rows, quote_text=True)


def _rows(document: Document) -> list[Row]:
    """Split a document into rows that are neither blank nor comments."""
    location = SourceLocation(document.path)
    try:
        rows = list(_split(document, _delimiter(document)))
    except csv.Error as error:
        raise location.error(f"not a readable table: {error}", LAYOUT) from None
    if len(rows) < 2:
        raise location.at(1).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    return rows


def _split(document: Document, delimiter: str) -> Iterator[Row]:
    line = 1
    lines = list(io.StringIO(document.text, newline=""))
    reader = csv.reader(lines, delimiter=delimiter, skipinitialspace=delimiter == BLANKS)
    for cells in reader:
        is_comment = lines[line - 1].lstrip().startswith("#")  # a quoted "#" is a name
        if cells and not is_comment and not (line == 1 and SEPARATOR.match(cells[0].lstrip())):
            plain = (plain_cell(cell.strip()) for cell in cells)
            texts = (cell for cell in plain if cell or delimiter != BLANKS)
            if row := trimmed(Cell(_decimal_point(cell, delimiter), line) for cell in texts):
                yield row
        line = reader.line_num + 1


def _decimal_point(cell: str, delimiter: str) -> str:
    """Replace a decimal comma by a point, unless the comma is the delimiter."""
    pointed = cell.replace(",", ".")
    return pointed if delimiter != "," and is_number(pointed) else cell


def _delimiter(document: Document) -> str:
    """Return the delimiter that the file states, or that splits off most wavelengths and numbers in a row."""
    if stated := SEPARATOR.fullmatch(document.lines[0].strip(" \ufeff\"'")):
        return stated[1]

    def numbers(delimiter: str) -> int:
        try:
            rows = list(itertools.islice(_split(document, delimiter), SAMPLE_ROWS))
        except csv.Error:
            return 0
        return max((sum(wavelength(cell.text) is not None for cell in row) for row in rows if len(row) > 1), default=0)

    return max((*DELIMITERS, BLANKS), key=numbers)
