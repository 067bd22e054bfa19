"""Spectra in a grid of cells: find the wavelengths, the names, and what belongs to neither.

Text tables, spreadsheets and CGATS files share this. A table may follow a preamble. Its wavelengths lie in a row, with
a row per spectrum below, or in a column, with a column per spectrum. Other columns may stand before and after them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from uplift.atlas.atlas import SLACK, VISIBLE
from uplift.atlas.document import SourceLocation, parse_number, without_unit
from uplift.atlas.measurements import Measurements, Spectrum, check_quantity, not_used_note, refuse_quantity
from uplift.common.text import parse_float

NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"
LAYOUT = "write a header row of wavelengths in nm and a row per entry, or the transpose"
SHORTEST = 100.0
"""Wavelength in nm that distinguishes a row of wavelengths from a wavelength and its values."""
MAX_PREAMBLE = 1000
"""Rows among which the first row of a table is searched."""
LABEL = re.compile(r"([^\d.,+-]{0,40}?)[\s_([]*(\d{3,4}(?:[.,]\d{1,6})?)\s*(?:nm)?\s*[)\]]?", re.IGNORECASE)
"""A prefix, a wavelength, and perhaps its unit: ``nm400``, ``R_400``, ``SPECTRAL_NM400``, ``Refl (400 nm)``."""
PREFIXES = frozenset(
    (
        "", "nm", "r", "%r", "r%", "%", "rnm", "ρ", "refl", "refl%", "rfl", "reflectance", "reflectivity", "spec",
        "spectral", "spectrum", "spectralnm", "spectrumnm", "wl", "wavelength", "lambda", "λ", "w", "x", "sci", "sce",
        "specin", "specex", "reflsci", "reflsce",
    )
)  # fmt: skip
"""What labels of wavelengths begin with, in lower case and without blanks."""
TRANSMITTANCE_PREFIXES = frozenset(("t", "%t", "t%", "trans", "tnm", "τ"))
NAME_LABELS = (
    "samplename", "name", "colorname", "colourname", "patchname", "patch", "label", "title", "sample", "material",
    "spectrum", "sampleid", "patchid", "id", "sampleloc", "sampleno", "no", "number", "index",
)  # fmt: skip
"""Labels of names, in lower case and without blanks, the preferred ones first."""


class Cell(NamedTuple):
    """Text of a cell, and its line."""

    text: str
    line: int


Row = tuple[Cell, ...]


@dataclass(frozen=True)
class Table:
    """Rows of equal width, of which the first one has the wavelengths in cells ``first`` to ``last`` − 1."""

    rows: tuple[Row, ...]
    first: int
    last: int
    layout: str

    @property
    def others(self) -> list[int]:
        """Indices of the columns that are not wavelengths."""
        return [*range(self.first), *range(self.last, len(self.rows[0]))]


def read_grid(rows: Sequence[Row], path: str, comments: str = "") -> Measurements:
    """Read the spectra of a grid of cells."""
    table = find_table(rows, path)
    header, *body = table.rows
    check_table_quantity(table, rows, path, comments)
    location = SourceLocation(path)
    nm = [_nanometres(cell, location) for cell in header[table.first : table.last]]
    name = name_column(table)
    spectra = [
        Spectrum(
            _name(row, name, number), nm, _values(row, table, name, path), None if name is None else row[name].line
        )
        for number, row in enumerate(body, 1)
    ]
    unused = not_used_note(header[index].text for index in table.others if index != name)
    return Measurements(tuple(spectra), notes=(table.layout, *unused))


def _name(row: Row, column: int | None, number: int) -> str:
    return f"sample {number}" if column is None else row[column].text


def find_table(rows: Sequence[Row], path: str) -> Table:
    """Find the table in a grid of cells. Raise `AtlasError`."""
    table = _in_row(rows, path) or _in_column(rows, path) or _without_cover(rows, path)
    if table is None:
        raise _not_a_table(rows, path)
    header = table.rows[0]
    is_plain = all(_is_number(cell.text) for cell in header[table.first : table.last])
    if not table.others and is_plain:
        raise SourceLocation(path, header[0].line).error("the header row is missing", LAYOUT)
    if len(table.rows) < 2:
        raise _not_a_table(rows, path)
    return table


def name_column(table: Table) -> int | None:
    """Return the column of the names: that of a usual label whose texts differ, or else the first one."""
    labels = {index: re.sub(r"[\s_.-]", "", table.rows[0][index].text.casefold()) for index in table.others}
    known = [index for wanted in NAME_LABELS for index, label in labels.items() if label == wanted]
    for index in known:
        names = [row[index].text for row in table.rows[1:]]
        if all(names) and len(set(names)) == len(names):
            return index
    return next(iter((*known, *table.others)), None)


def check_table_quantity(table: Table, rows: Sequence[Row], path: str, comments: str) -> None:
    """Raise `AtlasError` if the comments, the rows before the table or its labels name another quantity."""
    header = table.rows[0]
    location = SourceLocation(path, header[0].line)
    first = min(cell.line for cell in header)
    preamble = (cell.text for row in rows if row[0].line < first for cell in row)
    labels = (header[index].text for index in range(len(header)))
    check_quantity(" ".join((comments, *preamble, *labels)), location)
    prefix = _prefix(header[table.first].text)
    if prefix in TRANSMITTANCE_PREFIXES:
        refuse_quantity(
            f"the label '{header[table.first].text}' states transmittance, not reflectance",
            "measure the reflectance, or rename the columns: a cube holds reflectances",
            location,
        )


def wavelength(text: str) -> float | None:
    """Return the wavelength in nm that a cell states, None if it states none.

    >>> [wavelength(text) for text in ("400", "nm400", "R_400", "400.5 nm", "SPECTRAL_NM400", "LAB_L", "patch 400")]
    [400.0, 400.0, 400.0, 400.5, 400.0, None, None]
    """
    plain = without_unit(text)
    if _is_number(plain):
        return parse_float(plain)
    match = LABEL.fullmatch(text.strip())
    if match is None or _letters(match[1]) not in PREFIXES | TRANSMITTANCE_PREFIXES:
        return None
    return float(match[2].replace(",", "."))


def _in_row(rows: Sequence[Row], path: str) -> Table | None:
    """Find a row of wavelengths with rows of the same width below it."""
    for index, row in enumerate(rows[:MAX_PREAMBLE]):
        run = _best_run(row)
        if run is None:
            continue
        below = rows[index:]
        for other in below:
            _check_width(other, row, path)
        return Table(tuple(below), *run, "layout: a row per spectrum")
    return None


def _in_column(rows: Sequence[Row], path: str) -> Table | None:
    """Find a column of wavelengths in a block of rows of one width, and transpose the block."""
    for start in range(min(len(rows), MAX_PREAMBLE)):
        width = len(rows[start])
        if width < 2 or (start and len(rows[start - 1]) == width):
            continue
        end = start + 1
        while end < len(rows) and len(rows[end]) == width:
            end += 1
        for column in range(min(width, 3)):
            run = _best_run([row[column] for row in rows[start:end]])
            if run is None:
                continue
            for other in rows[end:]:
                _check_width(other, rows[start], path)
            block = [(row[column], *row[:column], *row[column + 1 :]) for row in rows[start:end]]
            return Table(tuple(zip(*block, strict=True)), *run, "layout: a column per spectrum")
    return None


def _without_cover(rows: Sequence[Row], path: str) -> Table | None:
    """Find wavelengths that do not cover the visible range, for the error that reports it."""
    for index, row in enumerate(rows[:MAX_PREAMBLE]):
        labelled = [run for run in _runs(row) if run[1] - run[0] > 2 and _prefix(row[run[0]].text)]
        if labelled:
            for other in rows[index:]:
                _check_width(other, row, path)
            return Table(tuple(rows[index:]), *labelled[0][:2], "")
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows) or len(rows[0]) < 2:
        return None
    for table in (tuple(rows), tuple(zip(*rows, strict=True))):
        if all(_is_number(without_unit(cell.text)) for cell in table[0][1:]):
            return Table(table, 1, len(table[0]), "")
    return None


def _best_run(cells: Sequence[Cell]) -> tuple[int, int] | None:
    """Return the first run of wavelengths that covers the visible range."""
    for first, last, numbers in _runs(cells):
        covers = SHORTEST <= min(numbers) <= VISIBLE[0] + SLACK and max(numbers) >= VISIBLE[1] - SLACK
        if last - first > 1 and covers:
            return first, last
    return None


def _runs(cells: Sequence[Cell]) -> Iterator[tuple[int, int, list[float]]]:
    """Yield runs of neighbouring wavelengths whose labels begin in the same way."""
    first, prefix, numbers = 0, "", list[float]()
    for index, cell in enumerate((*cells, Cell("", 0))):
        nm = wavelength(cell.text) if cell.text else None
        if nm is None or (numbers and _prefix(cell.text) != prefix):
            if numbers:
                yield first, index, numbers
            numbers = []
        if nm is not None:
            if not numbers:
                first, prefix = index, _prefix(cell.text)
            numbers.append(nm)


def _prefix(text: str) -> str:
    match = LABEL.fullmatch(text.strip())
    return "" if match is None or _is_number(without_unit(text)) else _letters(match[1])


def _letters(text: str) -> str:
    return re.sub(r"[^a-zλρτ%]", "", text.casefold())


def _not_a_table(rows: Sequence[Row], path: str) -> Exception:
    line = rows[0][0].line if rows else 1
    return SourceLocation(path, line).error(NO_TABLE, LAYOUT, code="not-an-atlas")


def _check_width(row: Row, header: Row, path: str) -> None:
    if len(row) != len(header):
        problem = f"a row must have {len(header)} cells like the header row, got {len(row)}"
        hint = "fill in the missing cells or remove the row"
        raise SourceLocation(path, row[0].line).error(problem, hint)


def _nanometres(cell: Cell, location: SourceLocation) -> float:
    nm = wavelength(cell.text)
    return parse_number(cell.text, location.at(cell.line), "wavelength") if nm is None else nm


def _values(row: Row, table: Table, name: int | None, path: str) -> list[float]:
    entry = None if name is None else row[name].text
    cells = row[table.first : table.last]
    return [parse_number(cell.text, SourceLocation(path, cell.line, entry), "value") for cell in cells]


def _is_number(text: str) -> bool:
    try:
        parse_float(text)
    except ValueError:
        return False
    return True


def trimmed(cells: Iterable[Cell]) -> Row:
    """Return a row without the empty cells at its end, which spreadsheets add."""
    kept = list(cells)
    while kept and not kept[-1].text.strip():
        kept.pop()
    return tuple(kept)
