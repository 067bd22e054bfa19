"""Delimited text: rows of cells, whose spectra `read_grid` finds."""

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import takewhile
from pathlib import Path

import numpy as np

from uplift.atlas.atlas import Atlas, Header
from uplift.atlas.document import Document, read_document
from uplift.common.errors import OutputError
from uplift.common.text import pluralise
from uplift.extras.files.csv import csv_text, find_delimiter, plain_cell
from uplift.extras.formats.measurements import Measurements
from uplift.extras.formats.quantities import POWER, REFLECTANCE, name_quantities
from uplift.extras.formats.statements import remark_scale
from uplift.extras.formats.tables.cells import (
    Cell,
    Line,
    Row,
    is_value,
    line_texts,
    trimmed,
)
from uplift.extras.formats.tables.grid import LAYOUT, Grid
from uplift.extras.formats.tables.read import read_grid

BLANKS = " "
"""Delimiter that stands for any number of blanks."""
SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)
"""First line of a table that states its delimiter to spreadsheets."""
QUOTED = re.compile(r'"\s*[+-]?\d{1,3},\d{3}')
"""A number in quotes that may have commas of thousands."""
SAMPLE_ROWS = 200
"""Rows by which the delimiter is chosen."""
COUNTED = ("Wavelength", "Reflectance", "standard deviation")
"""Columns below a line with their number of lines, as RELAB has them."""
SIGNATURE = ("nm", "reference (radiance)", "target (radiance)", "Reflectance [%]")
"""Columns below a line ``data=``, as spectrometers of Spectra Vista write them."""
WAVELENGTHS = "*[Ww]avelength*.txt"
"""Names of files of wavelengths, one a line below a title."""


def read(document: Document) -> Measurements:
    """Read the entries of a table, whose lines that begin with ``#`` are comments."""
    comments = [
        line.strip("# \t") for line in document.lines if line.lstrip().startswith("#")
    ]
    delimiter, rows = split_rows(document)
    rows = _labelled(rows)
    numbers = [row for row in rows if is_value(row[0].text)]
    if len(numbers) < 2 or max(map(len, numbers)) > 1:
        may_group = delimiter in ",\t" and bool(QUOTED.search(document.text))
        grid = Grid(rows, document.location, comments, may_group)
        return read_grid(grid, document.stem)
    title = next(
        (text for text in line_texts(rows) if not is_value(text)), document.stem
    )
    name, rows = _with_wavelengths(document, title, numbers)
    found = read_grid(Grid(rows, document.location, comments), document.stem)
    return replace(found, notes=(*found.notes, f"wavelengths: those of {name}"))


def split_rows(document: Document) -> tuple[str, list[Row]]:
    """Return the delimiter of a table, and its rows that are neither blank nor
    comments.
    """
    lines = document.lines
    try:
        delimiter = _delimiter(lines)
        return delimiter, list(_split(lines, delimiter))
    except (csv.Error, ValueError) as error:
        raise document.location.error(
            f"not a readable table: {error}", LAYOUT
        ) from None


def _labelled(rows: list[Row]) -> list[Row]:
    """Return rows with labels in place of the line above columns that a layout has
    without labels.
    """
    for at, row in enumerate(rows[:SAMPLE_ROWS]):
        if len(row) > 1:
            continue
        body = list(takewhile(lambda row: is_value(row[0].text), rows[at + 1 :]))
        labels = {"data=": SIGNATURE, str(len(body)): COUNTED}.get(row[0].text)
        if labels and body and 1 < len(body[0]) <= len(labels):
            heads = Line(labels[: len(body[0])], row[0].line)
            return [*rows[:at], heads, *rows[at + 1 :]]
    return rows


def _with_wavelengths(
    document: Document, title: str, values: Sequence[Row]
) -> tuple[str, list[Row]]:
    """Join values, one a line, with the wavelengths of another file, as the library of
    the USGS has them.

    Return the name of this file, and the rows.
    """
    found = list[tuple[str, list[Row]]]()
    for path in sorted(Path(document.path).parent.glob(WAVELENGTHS)):
        head, *lines = read_document(path).text.strip().split("\n")
        if len(lines) == len(values) and path != Path(document.path):
            rows = [
                (Cell(line.strip(), row[0].line), *row)
                for line, row in zip(lines, values, strict=True)
            ]
            labels = Cell(f"Wavelengths: {head}", 1), Cell(title, 1)
            found.append((path.name, [labels, *rows]))
    if len(found) != 1:
        problem = (
            f"has {pluralise(len(values), 'value')} without wavelengths, one a line"
        )
        hint = (
            "put the file of their wavelengths, with 'Wavelengths' in its name and as "
            "many lines, next to it"
        )
        raise document.location.error(problem, hint, code="not-an-atlas")
    return found[0]


def text(atlas: Atlas, _: Header) -> str:
    """Format a row per entry; `read` returns the same wavelengths and values, bit for
    bit.
    """
    first = atlas[0]
    for entry in atlas:
        if not np.array_equal(entry.wavelengths, first.wavelengths):
            problem = (
                f"entries '{first.name}' and '{entry.name}' are sampled at different "
                "wavelengths"
            )
            raise OutputError(
                problem,
                hint="write atlas text, which keeps each sampling, or separate tables",
            )
    stated = name_quantities(atlas.names)
    for name, quantity in zip(atlas.names, stated, strict=True):
        if remark_scale(name) or (
            quantity and quantity.kind not in (POWER, REFLECTANCE)
        ):
            raise OutputError(
                f"the name '{name}' states a scale or a quantity, which a table is "
                "read by",
                hint="rename the entry, or write atlas text",
            )
    rows = ([entry.name, *entry.values.tolist()] for entry in atlas)
    return csv_text(["name", *first.wavelengths.tolist()], rows, quote_text=True)


def _delimiter(lines: Sequence[str]) -> str:
    """Return the delimiter that the file states, or that splits off most numbers."""
    if stated := SEPARATOR.fullmatch(lines[0].strip(" \ufeff\"'")):
        return stated[1]
    return find_delimiter(lines[:SAMPLE_ROWS])


def _split(lines: Sequence[str], delimiter: str) -> Iterator[Row]:
    """Yield the rows that are neither blank nor comments."""
    line = 1
    reader = csv.reader(
        (f"{text}\n" for text in lines),
        delimiter=delimiter,
        skipinitialspace=delimiter == BLANKS,
    )
    for cells in reader:
        # A row of csv may span several lines; `line` is its first one.
        is_comment = lines[line - 1].lstrip().startswith("#")  # a quoted "#" is a name
        if (
            cells
            and not is_comment
            and not (line == 1 and SEPARATOR.match(cells[0].lstrip()))
        ):
            texts = list(map(str.strip, cells))
            if "'" in "".join(texts):
                texts = list(map(plain_cell, texts))
            if delimiter == BLANKS:
                texts = [text.rstrip(",;:") for text in texts if text]
                words = re.split(r"\s{2,}", lines[line - 1].strip())
                if len(words) > 1 and not any(
                    map(is_value, texts)
                ):  # labels of several words, in columns
                    texts = words
            if texts := trimmed(texts):
                yield Line(texts, line)
        line = reader.line_num + 1
