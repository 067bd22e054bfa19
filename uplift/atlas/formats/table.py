"""Spectra in a grid of cells: delimited text, and the grids of spreadsheets and CGATS files.

A table may follow a preamble. Its wavelengths lie in a row, with a row per spectrum below, or in a column, with a
column per spectrum. Other columns may stand before and after them.
"""

import csv
import io
import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.atlas.atlas import SLACK, VISIBLE, Atlas
from uplift.atlas.document import Document, SourceLocation, parse_number, without_unit
from uplift.atlas.measurements import Measurements, Spectrum, find_quantity, not_used_note, wrong_quantity
from uplift.common.csv import csv_text, plain_cell
from uplift.common.errors import AtlasError, OutputError
from uplift.common.text import parse_float, pluralise

NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"
LAYOUT = "write a header row of wavelengths in nm and a row per entry, or the transpose"
SHORTEST = 100.0
"""Wavelength in nm that distinguishes a row of wavelengths from a wavelength and its values."""
MAX_PREAMBLE = 1000
"""Rows among which the first row of a table is searched."""
DELIMITERS, BLANKS = ",;\t", " "
"""Delimiters of cells; the last one stands for any number of blanks."""
SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)
"""First line of a table that states its delimiter to spreadsheets."""
SAMPLE_ROWS = 200
"""Rows by which the delimiter is chosen."""
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
"""Labels of names, in lower case without blanks and punctuation, the preferred ones first."""
SAMPLE_LABELS = (
    NAME_LABELS,
    ("wavelength", "wavelength(nm)", "wavelengthnm", "lambda", "λ", "wl", "nm"),
    ("reflectance", "reflectivity", "value", "refl", "r", "r%", "%r"),
)
"""Labels of the three columns of a table with a row per sample."""


class Cell(NamedTuple):
    """Text of a cell, and its line."""

    text: str
    line: int


Row = tuple[Cell, ...]


class Run(NamedTuple):
    """Neighbouring wavelengths in nm in cells ``first`` to ``last`` − 1, and what their labels begin with."""

    first: int
    last: int
    prefix: str
    nm: list[float]

    def is_visible(self) -> bool:
        """Whether they cover the visible range."""
        low, high = min(self.nm), max(self.nm)
        return len(self.nm) > 1 and SHORTEST <= low <= VISIBLE[0] + SLACK and high >= VISIBLE[1] - SLACK

    def is_labelled(self) -> bool:
        """Whether their labels are those of wavelengths, of any range."""
        return len(self.nm) > 2 and bool(self.prefix)


@dataclass(frozen=True)
class Table:
    """Rows of equal width, of which the first one has the wavelengths."""

    rows: tuple[Row, ...]
    run: Run
    layout: str

    @property
    def others(self) -> list[int]:
        """Indices of the columns that are not wavelengths."""
        return [*range(self.run.first), *range(self.run.last, len(self.rows[0]))]


def read(document: Document) -> Measurements:
    """Read the entries of a table: a row or a column per spectrum, or the two columns of a single spectrum.

    Lines that begin with ``#`` are comments. Rows before the table are its preamble.
    """
    comments = "\n".join(line for line in document.lines if line.lstrip().startswith("#"))
    try:
        rows = list(_split(document, _delimiter(document)))
    except csv.Error as error:
        raise document.location.error(f"not a readable table: {error}", LAYOUT) from None
    if len(rows) > 1 and all(len(row) == 2 and all(is_number(cell.text) for cell in row) for row in rows):
        nm, values = ([parse_float(row[column].text) for row in rows] for column in (0, 1))
        spectrum = Spectrum(document.stem, nm, values, line=rows[0][0].line)
        return Measurements((spectrum,), notes=("layout: wavelength and value", "name: that of the file"))
    return _read_samples(rows, document.location) or read_grid(rows, document.location, comments)


def _read_samples(rows: Sequence[Row], location: SourceLocation) -> Measurements | None:
    """Read a table with a row per sample: a name, a wavelength and a reflectance, in any order of columns."""
    header, *body = rows or ((),)
    labels = [_plain_label(cell.text) for cell in header]
    columns = [next((labels.index(name) for name in names if name in labels), -1) for names in SAMPLE_LABELS]
    if -1 in columns or any(len(row) != len(header) for row in body):
        return None
    found: dict[str, list[tuple[float, float]]] = {}
    for row in body:
        name, nm, value = (row[column] for column in columns)
        here = location.at(nm.line, name.text)
        samples = found.setdefault(name.text, [])
        samples.append((parse_number(nm.text, here, "wavelength"), parse_number(value.text, here, "value")))
    spectra = (Spectrum(name, *np.array(sorted(samples)).T) for name, samples in found.items())
    return Measurements(tuple(spectra), notes=("layout: a row per sample",))


def _plain_label(text: str) -> str:
    """Return a label in lower case without blanks and punctuation."""
    return re.sub(r"[\s_.-]", "", text.casefold())


def text(atlas: Atlas) -> str:
    """Format a row per entry; `read` returns the same wavelengths and values, bit for bit."""
    first = atlas[0]
    for entry in atlas:
        if not np.array_equal(entry.wavelengths, first.wavelengths):
            problem = f"entries '{first.name}' and '{entry.name}' are sampled at different wavelengths"
            raise OutputError(problem, hint="write atlas text, which keeps each sampling, or separate tables")
    rows = ([entry.name, *entry.values.tolist()] for entry in atlas)
    return csv_text(["name", *first.wavelengths.tolist()], rows, quote_text=True)


def _delimiter(document: Document) -> str:
    """Return the delimiter that the file states, or that splits off most wavelengths and numbers in a row."""
    if stated := SEPARATOR.fullmatch(document.lines[0].strip(" \ufeff\"'")):
        return stated[1]

    def numbers(delimiter: str) -> int:
        try:
            rows = list(itertools.islice(_split(document, delimiter), SAMPLE_ROWS))
        except csv.Error:
            return 0
        return max(
            (sum(split_label(cell.text)[1] is not None for cell in row) for row in rows if len(row) > 1), default=0
        )

    return max((*DELIMITERS, BLANKS), key=numbers)


def _split(document: Document, delimiter: str) -> Iterator[Row]:
    """Yield the rows that are neither blank nor comments. A decimal comma becomes a point."""
    line = 1
    lines = list(io.StringIO(document.text, newline=""))
    reader = csv.reader(lines, delimiter=delimiter, skipinitialspace=delimiter == BLANKS)
    for cells in reader:
        # A row of csv may span several lines; `line` is its first one.
        is_comment = lines[line - 1].lstrip().startswith("#")  # a quoted "#" is a name
        if cells and not is_comment and not (line == 1 and SEPARATOR.match(cells[0].lstrip())):
            texts = [plain_cell(cell.strip()) for cell in cells]
            if delimiter == BLANKS:
                texts = list(filter(None, texts))
            if delimiter != ",":
                texts = [pointed if is_number(pointed := each.replace(",", ".")) else each for each in texts]
            if row := trimmed(Cell(each, line) for each in texts):
                yield row
        line = reader.line_num + 1


def read_grid(rows: Sequence[Row], location: SourceLocation, comments: str = "") -> Measurements:
    """Read the spectra of a grid of cells."""
    table = _find_table(rows, location)
    header, *body = table.rows
    name = _name_column(table)
    spectra = []
    for number, row in enumerate(body, 1):
        label = f"sample {number}" if name is None else row[name].text
        cells = row[table.run.first : table.run.last]
        try:
            values = [parse_float(cell.text) for cell in cells]
        except ValueError:  # the first of them is named, by its own line
            values = [parse_number(cell.text, location.at(cell.line, label), "value") for cell in cells]
        line = None if name is None else row[name].line
        spectra.append(Spectrum(label, table.run.nm, values, line=line))
    unused = not_used_note(header[index].text for index in table.others if index != name)
    refusal = _refusal(table, rows, location, comments)
    return Measurements(tuple(spectra), notes=(table.layout, *unused), refusal=refusal)


def _find_table(rows: Sequence[Row], location: SourceLocation) -> Table:
    """Find the table in a grid of cells. Raise `AtlasError`."""
    table = (
        _in_row(rows, location, Run.is_visible)
        or _in_column(rows, location)
        or _in_row(rows, location, Run.is_labelled)  # entries are refused: they are not all visible light
        or _of_numbers(rows)
    )
    if table is None or len(rows) < 2 or len(table.rows) < 2:
        raise location.at(rows[0][0].line if rows else 1).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    header = table.rows[0]
    unlabelled = not table.others and all(is_number(cell.text) for cell in header)
    if unlabelled or (not table.layout and max(table.run.nm) < SHORTEST):
        raise location.at(header[0].line).error("the header row is missing", LAYOUT)
    return table


def _in_row(rows: Sequence[Row], location: SourceLocation, wanted: Callable[[Run], bool]) -> Table | None:
    """Find a row of wavelengths with rows of the same width below it."""
    for index, row in enumerate(rows[:MAX_PREAMBLE]):
        for run in filter(wanted, _runs(row)):
            return Table(_of_one_width(rows[index:], location), run, "layout: a row per spectrum")
    return None


def _in_column(rows: Sequence[Row], location: SourceLocation) -> Table | None:
    """Find a column of wavelengths in a block of rows of one width, and transpose the block."""
    # Blocks of one width: the preamble often has another one.
    start = 0
    for width, group in itertools.groupby(rows, key=len):
        block = list(group)
        for column in range(min(width, 3) if width > 1 else 0):
            for run in _runs([row[column] for row in block]):
                if run.is_visible():
                    below = _of_one_width(rows[start:], location)
                    turned = zip(*((row[column], *row[:column], *row[column + 1 :]) for row in below), strict=True)
                    return Table(tuple(turned), run, "layout: a column per spectrum")
        start += len(block)
        if start >= MAX_PREAMBLE:
            break
    return None


def _of_numbers(rows: Sequence[Row]) -> Table | None:
    """Take numbers after a first cell for wavelengths; they do not cover the visible range, so entries are refused."""
    if len(rows) < 2 or len(rows[0]) < 2 or any(len(row) != len(rows[0]) for row in rows):
        return None
    for table in (tuple(rows), tuple(zip(*rows, strict=True))):
        numbers = [without_unit(cell.text) for cell in table[0][1:]]
        if all(map(is_number, numbers)):
            return Table(table, Run(1, len(table[0]), "", list(map(parse_float, numbers))), "")
    return None


def _of_one_width(rows: Sequence[Row], location: SourceLocation) -> tuple[Row, ...]:
    """Return rows that are as wide as the first one. Raise `AtlasError` for others."""
    for row in rows:
        if len(row) != len(rows[0]):
            problem = f"a row must have {pluralise(len(rows[0]), 'cell')} like the header row, got {len(row)}"
            hint = "fill in the missing cells"
            if len(row) > len(rows[0]):
                hint = "put a name that contains the separator in quotes, or remove the other cells"
            raise location.at(row[0].line).error(problem, hint)
    return tuple(rows)


def _runs(cells: Sequence[Cell]) -> Iterator[Run]:
    """Yield runs of neighbouring wavelengths whose labels begin in the same way."""
    labels = [split_label(cell.text) for cell in cells]
    prefixes = (None if nm is None else prefix for prefix, nm in labels)
    last = 0
    for prefix, group in itertools.groupby(prefixes):
        first, last = last, last + len(list(group))
        if prefix is not None:
            yield Run(first, last, prefix, [nm for _, nm in labels[first:last] if nm is not None])


def _name_column(table: Table) -> int | None:
    """Return the column of the names: that of a usual label whose texts differ, or else the first one."""
    # Labels that state a name come before those of numbers, unless they repeat a name.
    labels = {index: _plain_label(table.rows[0][index].text) for index in table.others}
    known = [index for wanted in NAME_LABELS for index, label in labels.items() if label == wanted]
    for index in known:
        names = [row[index].text for row in table.rows[1:]]
        if all(names) and len(set(names)) == len(names):
            return index
    return next(iter((*known, *table.others)), None)


def _refusal(table: Table, rows: Sequence[Row], location: SourceLocation, comments: str) -> AtlasError | None:
    """Return the error for comments, rows before the table or labels that name another quantity."""
    header = table.rows[0]
    location = location.at(header[0].line)
    first = min(cell.line for cell in header)
    preamble = (cell.text for row in rows if row[0].line < first for cell in row)
    if table.run.prefix in TRANSMITTANCE_PREFIXES:
        label = header[table.run.first].text
        return wrong_quantity(f"the label '{label}' states transmittance, not reflectance", location)
    return find_quantity(" ".join((comments, *preamble, *(cell.text for cell in header))), location)


def split_label(text: str) -> tuple[str, float | None]:
    """Return what a label begins with, and its wavelength in nm; None if it states no wavelength.

    >>> [split_label(text) for text in ("400", "R_400", "400.5 nm", "SPECTRAL_NM400", "LAB_L", "patch 400")]
    [('', 400.0), ('r', 400.0), ('', 400.5), ('spectralnm', 400.0), ('', None), ('', None)]
    """
    number = without_unit(text)
    if is_number(number):
        return "", parse_float(number)
    match = LABEL.fullmatch(text.strip())
    prefix = "" if match is None else re.sub(r"[^a-zλρτ%]", "", match[1].casefold())
    if match is None or prefix not in PREFIXES | TRANSMITTANCE_PREFIXES:
        return "", None
    return prefix, float(match[2].replace(",", "."))


def is_number(text: str) -> bool:
    """Whether `parse_float` accepts a text."""
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
