"""Spectra in a grid of cells: where its wavelengths, values and labels are, and what the text around them states.

Wavelengths lie in a row, with a row per spectrum below; in a column, with a column per spectrum; or in a column before
each spectrum. All else is text: preamble, comments, lines below.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from uplift.atlas.atlas import SkippedEntry
from uplift.atlas.document import SourceLocation, truncate
from uplift.atlas.formats.cells import (
    SHORTEST,
    Cell,
    Row,
    Run,
    covers_visible,
    is_value,
    is_visible,
    line_texts,
    parse_cell,
    parse_label,
    runs,
)
from uplift.atlas.measurements import Measurements, Spectrum, is_missing, not_used_note
from uplift.atlas.statements import (
    METRE,
    NANOMETRE,
    PERCENT,
    Scale,
    find_unit,
    is_photometric,
    is_plain,
    label_quantity,
    label_scale,
    name_quantity,
    names_wavelengths,
    remark_quantity,
    remark_scale,
    remark_unit,
    to_nm,
    unit_by_values,
)
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError
from uplift.common.text import pluralise

NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"
LAYOUT = "write a header row of wavelengths in nm and a row per entry, or the transpose"
MAX_PREAMBLE = 1000
"""Rows among which the row of wavelengths is searched."""
MAX_HEADS = 4
"""Rows of labels above columns."""
MAX_AXIS = 3
"""Columns among which that of the wavelengths is searched."""
EQUAL = 1e-6
"""Tolerance in nm of equal steps."""
NAME_LABELS = (
    "samplename", "name", "colorname", "colourname", "patchname", "patch", "label", "title", "sample", "material",
    "spectrum", "sampleid", "patchid", "id", "sampleloc", "sampleno", "no", "number", "index",
)  # fmt: skip
"""Labels of names, in lower case without blanks and punctuation, the preferred ones first."""


class Series(NamedTuple):
    """The cells of one spectrum, their wavelengths in nm, what their label states, and the cell of the name if any."""

    label: str
    nm: Sequence[float]
    cells: Row
    name: Cell | None


@dataclass(frozen=True)
class Table:
    """The spectra of a grid, the lines of text around them, and notes."""

    series: Sequence[Series]
    remarks: Sequence[str]
    notes: tuple[str, ...]
    skipped: tuple[SkippedEntry, ...] = ()


@dataclass(frozen=True)
class Grid:
    """Rows of cells of a file, and its comments."""

    rows: Sequence[Row]
    location: SourceLocation
    comments: Sequence[str] = ()

    @cached_property
    def unit(self) -> float | None:
        """Unit of wavelengths that a line of text states, see `find_unit`."""
        return remark_unit([*self.comments, *line_texts(self.rows[:MAX_PREAMBLE])])

    def column(self, column: int) -> Row:
        """Return a column; rows that do not reach it have a text there."""
        return tuple(row[column] if column < len(row) else Cell("short", row[0].line) for row in self.rows)

    def remarks(self, first: int, last: int | None = None) -> list[str]:
        """Return the comments, and the lines before row ``first`` and from row ``last`` on."""
        below = [] if last is None else line_texts(self.rows[last:])
        return [*self.comments, *line_texts(self.rows[:first]), *below]


@dataclass(frozen=True)
class Block:
    """Neighbouring rows with wavelengths in one column, and the rows of labels above them."""

    grid: Grid
    run: Run
    column: int

    @cached_property
    def rows(self) -> Sequence[Row]:
        """Rows of numbers."""
        return self.grid.rows[self.run.first : self.run.last]

    @cached_property
    def width(self) -> int:
        """Cells of the widest row."""
        return max(map(len, self.rows))

    @cached_property
    def heads(self) -> Sequence[Row]:
        """Rows of labels, from top to bottom."""
        first = last = self.run.first
        while last - first < MAX_HEADS and first and self._is_head(self.grid.rows[first - 1]):
            first -= 1
        return self.grid.rows[first:last]

    @cached_property
    def remarks(self) -> list[str]:
        """Lines of text around the block."""
        return self.grid.remarks(self.run.first - len(self.heads), self.run.last)

    @cached_property
    def unit(self) -> float:
        """Unit of the wavelengths, see `find_unit`."""
        label = " ".join(cell.text for cell in self.labels(self.column))
        stated = self.run.unit or find_unit(label)
        if stated is not None:
            return stated
        # The lines around may be about another range.
        if self.grid.unit is not None and is_visible(to_nm(self.run.numbers, self.grid.unit)):
            return self.grid.unit
        if names_wavelengths(label):  # in any order
            return unit_by_values(np.unique(self.run.numbers))
        return unit_by_values(self.run.numbers) if self.column == 0 else NANOMETRE

    @cached_property
    def nm(self) -> Array:
        """Wavelengths in nm."""
        return to_nm(self.run.numbers, self.unit)

    def labels(self, column: int) -> list[Cell]:
        """Return the labels above a column, from top to bottom."""
        return [cell for row in self.heads for cell in row[column : column + 1] if cell.text]

    def cells(self, column: int) -> Row:
        """Return a column; the ends of short rows are empty."""
        return tuple(_cell(row, column) for row in self.rows)

    def _is_head(self, row: Row) -> bool:
        """Whether a row has labels: those of columns of text, or of numbers next to a label of wavelengths."""
        if not self.column < len(row) <= self.width or row[self.column].text.endswith(":"):
            return False
        corner = row[self.column].text
        labels = [cell.text for cell in row if cell.text and cell is not row[self.column]]
        has_numbers = any(map(is_value, labels))
        if names_wavelengths(corner):
            return bool(labels) or len(corner.split()) == 1
        return bool(labels) and (not has_numbers or not corner)


def read_grid(grid: Grid, stem: str) -> Measurements:
    """Read the spectra of a grid. One without a name has that of the file, ``stem``."""
    table = _samples(grid) or _rows_or_columns(grid)
    scales = [remark_scale(text) for text in table.remarks]
    nameless = [series for series in table.series if series.name is None]
    spectra = list[Spectrum]()
    for series in table.series:
        first = series.cells[0]
        name = series.name or Cell(stem if len(nameless) == 1 else series.label, first.line)
        quantity = label_quantity(series.label) or name_quantity(name.text)
        if not name.text and series.name is None:
            raise grid.location.at(first.line).error("the header row is missing", LAYOUT)
        values, percent = _values(series.cells, grid.location.at(entry=name.text))
        if quantity is None or quantity.is_reflectance:
            scales += [label_scale(series.label), remark_scale(name.text), percent]
        spectra.append(Spectrum(name.text, series.nm, values, line=name.line, quantity=quantity))
    stated = [scale for scale in scales if scale is not None]
    return Measurements(
        tuple(spectra),
        skipped=table.skipped,
        scales=tuple(stated),
        notes=table.notes,
        quantity=remark_quantity(table.remarks),
    )


def _values(cells: Row, location: SourceLocation) -> tuple[list[float], Scale | None]:
    """Parse the values of a spectrum, NaN where one is missing, and the scale that percent signs in cells state."""
    values = list[float]()
    percents = [cell.text for cell in cells if cell.text.endswith("%")]
    for cell in cells:
        value = parse_cell(cell.text)
        if value is None:
            problem = f"value '{truncate(cell.text)}' is not a number"
            raise location.at(cell.line).error(problem, "write a plain number such as 0.125")
        values.append(value)
    if not percents:
        return values, None
    if len(percents) < (~is_missing(values)).sum():
        problem = f"{len(percents)} of {pluralise(len(cells), 'value')} are in percent, such as '{percents[0]}'"
        raise location.at(cells[0].line).error(problem, "give all or none in percent", code="mixed-scales")
    return values, Scale(PERCENT, percents[0])


def _plain_label(text: str) -> str:
    """Return a label in lower case without units, scales, blanks and punctuation."""
    return re.sub(r"[(\[].*|[\s_.%-]", "", text.casefold())


def _samples(grid: Grid) -> Table | None:
    """Read a table with a row per sample: a name, a wavelength and a reflectance, in any order of columns."""
    for index, header in enumerate(grid.rows[:MAX_PREAMBLE]):
        if is_value(header[-1].text):
            continue
        name = _first(header, lambda text: _plain_label(text) in NAME_LABELS)
        wavelength = _first(header, names_wavelengths)
        value = _first(header, lambda text: is_plain(text) or text in ("R", "r"))
        if name is not None and wavelength is not None and value is not None:
            return _sample_table(grid, index, (name, wavelength, value))
    return None


def _first(header: Row, is_wanted: Callable[[str], bool]) -> int | None:
    """Return the first column whose label is wanted."""
    return next((column for column, cell in enumerate(header) if is_wanted(cell.text)), None)


def _sample_table(grid: Grid, index: int, columns: tuple[int, int, int]) -> Table | None:
    """Return a spectrum for each name in the first of three columns; the header is the row of an index."""
    header = grid.rows[index]
    remarks = grid.remarks(index)
    found: dict[str, list[tuple[float, Cell]]] = {}
    for row in grid.rows[index + 1 :]:
        name, wavelength, value = [_cell(row, column) for column in columns]
        label = parse_label(wavelength.text)
        if label is not None:
            found.setdefault(name.text, []).append((label.number, value))
        elif is_value(value.text):
            problem = f"wavelength '{truncate(wavelength.text)}' is not a number"
            raise grid.location.at(row[0].line, name.text).error(problem, "write a plain number such as 400")
        else:
            remarks += line_texts([row])
    are_measured = any(is_value(name) and not name.isdigit() for name in found)
    if not found or are_measured or min(map(len, found.values())) < 2:  # another layout
        return None
    numbers = [number for samples in found.values() for number, _ in samples]
    _, wavelength_column, value_column = columns
    unit = find_unit(header[wavelength_column].text) or grid.unit or unit_by_values(np.unique(numbers))
    series = list[Series]()
    for text, samples in found.items():
        nm = to_nm([number for number, _ in samples], unit).tolist()
        cells = tuple(cell for _, cell in samples)
        series.append(Series(header[value_column].text, nm, cells, Cell(text, cells[0].line)))
    return Table(series, remarks, ("layout: a row per sample",))


def _cell(row: Row, column: int) -> Cell:
    """Return a cell of a row, empty beyond its end."""
    return row[column] if column < len(row) else Cell("", row[0].line)


def _rows_or_columns(grid: Grid) -> Table:
    """Find the row or the column of wavelengths. Raise `AtlasError` if there is none, or if both may be meant."""
    header = max(_headers(grid), key=lambda header: len(header.nm), default=None)
    block = max(_blocks(grid), key=lambda block: len(block.rows), default=None)
    if block is None:
        if header is None:
            raise _no_table(grid)
        return _wide(grid, header)
    if header is None or header.at != block.run.first - 1:
        return _tall(block)
    corner = grid.rows[header.at][block.column]
    if _plain_label(corner.text) in NAME_LABELS:
        return _wide(grid, header)
    problem = "the first row and the first column may both be wavelengths"
    raise grid.location.at(corner.line).error(problem, "label the names 'name', or give them letters")


class Header(NamedTuple):
    """A row of wavelengths: its index, the cells of the wavelengths, and their numbers in nm."""

    at: int
    run: Run
    nm: Array


def _headers(grid: Grid) -> Iterator[Header]:
    """Yield the indices of rows with wavelengths in nm, and numbers in the row below."""
    for index, row in enumerate(grid.rows[:MAX_PREAMBLE]):
        for run in runs(row):
            nm = to_nm(run.numbers, run.unit or grid.unit or (METRE if max(run.numbers) < 1e-5 else NANOMETRE))
            below = grid.rows[index + 1][run.first : run.last] if index + 1 < len(grid.rows) else ()
            numbers = [value for cell in below if (value := parse_cell(cell.text)) is not None]
            has_values = bool(numbers) and not (len(numbers) > 1 and is_visible(np.array(numbers)))
            is_named = run.first == 1 and _plain_label(row[0].text) in NAME_LABELS and covers_visible(nm)
            if has_values and (is_visible(nm) or is_named or (run.prefix and len(nm) > 2)):
                yield Header(index, run, nm)


def _wide(grid: Grid, wavelengths: Header) -> Table:
    """Return a spectrum for each row below a row of wavelengths that has a value at one of them."""
    index, run, nm = wavelengths
    header = grid.rows[index]
    remarks = grid.remarks(index)
    body = list[Row]()
    for row in grid.rows[index + 1 :]:
        line = row[0].line
        if not any(is_value(cell.text) for cell in row[run.first : run.last]):
            remarks += line_texts([row])
            continue
        if len(row) > len(header):
            problem = f"a row must have {pluralise(len(header), 'cell')} like the header row, got {len(row)}"
            hint = "put a name that contains the separator in quotes, or remove the other cells"
            raise grid.location.at(line).error(problem, hint)
        body.append((*row, *[Cell("", line)] * (len(header) - len(row))))
    others = [*range(run.first), *range(run.last, len(header))]
    column = _name_column(header, body, others)
    label = header[run.first].text if run.prefix else ""
    series = list[Series]()
    for number, row in enumerate(body, 1):
        name = Cell(f"sample {number}", row[0].line) if column is None else row[column]
        series.append(Series(label, nm.tolist(), row[run.first : run.last], name))
    unused = [header[other].text for other in others if other != column]
    remarks += filter(is_photometric, unused)
    if column is not None:
        remarks.append(header[column].text)
    return Table(series, remarks, ("layout: a row per spectrum", *not_used_note(unused)))


def _name_column(header: Row, body: Sequence[Row], others: Sequence[int]) -> int | None:
    """Return the column of the names: that of a usual label whose texts differ, or else the first one."""
    # Labels that state a name come before those of numbers, unless they repeat a name.
    labels = {index: _plain_label(header[index].text) for index in others}
    known = [index for wanted in NAME_LABELS for index, label in labels.items() if label == wanted]
    for index in known:
        names = [row[index].text for row in body]
        if all(names) and len(set(names)) == len(names):
            return index
    return next(iter((*known, *others)), None)


def _blocks(grid: Grid) -> Iterator[Block]:
    """Yield the blocks of rows that begin with wavelengths in the visible range."""
    for column in range(MAX_AXIS):
        for run in runs(grid.column(column)):
            block = Block(grid, run, column)
            if is_visible(block.nm) and block.width > column + 1:
                yield block


def _tall(block: Block) -> Table:
    """Return a spectrum for each column of values of a block."""
    notes = ["layout: wavelength and value" if block.width == 2 else "layout: a column per spectrum"]
    skipped = list[SkippedEntry]()
    for other in _blocks(block.grid):
        if other.column == block.column and other.run != block.run:
            line = other.rows[0][0].line
            reason = "a file has one table: write it to another file"
            skipped.append(SkippedEntry(f"lines from {line} on", reason, block.grid.location.path, line))
    axes = _axes(block)
    if pairs := _pairs(block):
        return Table([pairs], block.remarks, ("layout: several pairs a line",))
    series, unused = list[Series](), list[str]()
    axis = block.column
    prefix = block.rows[0][axis].text if block.run.prefix else ""
    for column in range(block.width):
        if column in axes:
            # Of neighbouring columns of wavelengths the first one counts: others repeat it in other units.
            axis = axis if column - 1 in axes else column
            continue
        cells = block.cells(column)
        labels = block.labels(column)
        label = " ".join([prefix, *(cell.text for cell in labels)]).strip()
        if column < block.column or not any(is_value(cell.text) for cell in cells):
            unused.append(label)
            continue
        if axis != block.column:  # the name may stand above the wavelengths
            labels = [cell for cell in block.labels(axis) if not names_wavelengths(cell.text)] + labels
        # Names stand next to the values, or above their quantity and unit.
        if block.heads and not labels:
            problem = f"column {column + 1} has values and no label"
            hint = "label it, and use another separator than the decimal comma"
            raise block.grid.location.at(cells[0].line).error(problem, hint)
        names = [cell for cell in reversed(labels) if not is_plain(cell.text)]
        name = next((cell for cell in names if len(cell.text) > 1), next(iter(names), None))
        known = np.flatnonzero(np.isfinite(axes[axis])).tolist()
        series.append(Series(label, axes[axis][known].tolist(), tuple(cells[row] for row in known), name))
    if not series:
        raise _no_table(block.grid)
    return Table(series, block.remarks, (*notes, *not_used_note(unused)), tuple(skipped))


def _axes(block: Block) -> dict[int, Array]:
    """Return the wavelengths in nm of each column that has them, NaN where a cell is empty."""
    axes = {block.column: block.nm}
    own_labels = [cell.text for cell in block.labels(block.column)]
    for column in range(block.column + 1, block.width):
        labels = [cell.text for cell in block.labels(column)]
        if labels and (labels == own_labels or any(map(names_wavelengths, labels))):
            numbers = np.array([parse_cell(cell.text) for cell in block.cells(column)], dtype=float)
            nm = to_nm(numbers, find_unit(" ".join(labels)) or block.unit)
            if (nm >= SHORTEST).any():
                axes[column] = nm
    return axes


def _pairs(block: Block) -> Series | None:
    """Return the spectrum whose wavelengths go on from pair to pair in equal steps, and then to the next line."""
    labels = [cell.text for head in block.heads for cell in head]
    is_labelled = not all(is_plain(label) or names_wavelengths(label) for label in labels)
    wavelengths = [parse_label(cell.text) for row in block.rows for cell in row[::2]]
    cells = tuple(cell for row in block.rows for cell in row[1::2])
    numbers = [label.number for label in wavelengths if label is not None]
    if block.width < 4 or is_labelled or not len(numbers) == len(wavelengths) == len(cells):
        return None
    nm = to_nm(numbers, block.unit)
    return None if np.ptp(np.diff(nm)) > EQUAL else Series("", nm.tolist(), cells, None)


def _no_table(grid: Grid) -> AtlasError:
    """Create the error for a grid without spectra."""
    if not grid.rows:
        return grid.location.at(1).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    columns = [grid.column(column) for column in range(MAX_AXIS)]
    for cells in (*grid.rows[:MAX_PREAMBLE], *columns):
        for run in runs(cells):
            nm = to_nm(run.numbers, run.unit or grid.unit or NANOMETRE)
            if len(nm) > 2 and (run.prefix or nm.min() >= SHORTEST):
                problem = f"wavelengths must cover 400–700 nm, got {nm.min():g}–{nm.max():g} nm"
                hint = "add the missing wavelengths, or state their unit in a label, such as 'Wavelength (µm)'"
                return grid.location.at(cells[run.first].line).error(problem, hint)
    first = grid.rows[0]
    layout = f"a table whose first line has {pluralise(len(first), 'cell')}, '{truncate(line_texts([first])[0])}'"
    problem = f"{NO_TABLE}: read as {layout}"
    return grid.location.at(first[0].line).error(problem, LAYOUT, code="not-an-atlas")
