"""Spectra in columns: a column of wavelengths with a column per spectrum, one before
each, or pairs on a line.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np

from uplift.atlas.atlas import SkippedEntry
from uplift.common.arrays import Array
from uplift.extras.formats.measurements import not_used_note
from uplift.extras.formats.statements import (
    NANOMETRE,
    find_unit,
    is_plain,
    names_wavelengths,
    to_nm,
    unit_by_values,
)
from uplift.extras.formats.tables.cells import (
    SHORTEST,
    Cell,
    Row,
    Run,
    are_wavelengths,
    is_value,
    is_visible,
    line_texts,
    parse_cell,
    runs,
    texts_of,
)
from uplift.extras.formats.tables.grid import (
    MAX_AXIS,
    MAX_HEADS,
    Grid,
    Series,
    Table,
    cell_at,
)

PAIRS = 4
"""Cells of at least two pairs."""
EQUAL = 1e-6
"""Tolerance in nm of equal steps."""


@dataclass(frozen=True)
class Block:
    """Neighbouring rows with wavelengths in one column, and the rows of labels above
    them.
    """

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
        while (
            last - first < MAX_HEADS
            and first
            and self._is_head(self.grid.rows[first - 1])
        ):
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
        if self.grid.unit is not None and is_visible(
            to_nm(self.run.numbers, self.grid.unit)
        ):
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
        cells = [cell_at(row, column) for row in self.heads]
        return [cell for cell in cells if cell.text]

    def cells(self, column: int) -> Row:
        """Return a column; the ends of short rows are empty."""
        return tuple(cell_at(row, column) for row in self.rows)

    def label(self, column: int) -> str:
        """Return the text of the labels above a column, after what the labels of all
        wavelengths begin with.
        """
        prefix = self.rows[0][self.column].text if self.run.prefix else ""
        return " ".join([prefix, *(cell.text for cell in self.labels(column))]).strip()

    def has_values(self, column: int) -> bool:
        """Whether a column has a number, or a mark of a missing one."""
        return any(is_value(cell.text) for cell in self.cells(column))

    def _is_head(self, row: Row) -> bool:
        """Whether a row has labels: those of columns of text, or of numbers next to a
        label of wavelengths.
        """
        if not self.column < len(row) <= self.width or row[self.column].text.endswith(
            ":"
        ):
            return False
        texts = list(texts_of(row))
        corner = texts.pop(self.column)
        labels = list(filter(None, texts))
        has_numbers = any(map(is_value, labels))
        if names_wavelengths(corner):
            return bool(labels) or len(corner.split()) == 1
        return bool(labels) and (not has_numbers or not corner)


def blocks(grid: Grid) -> Iterator[Block]:
    """Yield the blocks of rows that begin with wavelengths in the visible range."""
    for column in range(MAX_AXIS):
        for run in runs(grid.column(column)):
            block = Block(grid, run, column)
            if not is_visible(block.nm):  # numbers of the preamble, a line each
                block = Block(grid, _without_preamble(grid, run, column), column)
            if is_visible(block.nm) and block.width > column + 1:
                yield block


def _without_preamble(grid: Grid, run: Run, column: int) -> Run:
    """Return a run without the rows at its beginning that end with its column."""
    last = run.last - 1
    rows = range(run.first, last)
    first = next((at for at in rows if len(grid.rows[at]) > column + 1), last)
    return run._replace(first=first, numbers=run.numbers[first - run.first :])


def spectra_of(block: Block, others: Sequence[Block]) -> Table:
    """Return a spectrum for each column of values of a block; the ``others`` of the
    file are skipped.
    """
    if pairs := _pairs(block):
        return Table([pairs], block.remarks, ("layout: several pairs a line",))
    series = list[Series]()
    unused = list[str]()
    axes = _axes(block)
    axis = block.column
    for column in range(block.width):
        if column in axes:
            # Of neighbouring columns of wavelengths the first one counts: others repeat
            # it in other units.
            axis = axis if column - 1 in axes else column
        elif column > block.column and block.has_values(column):
            series.append(_series(block, column, axis, axes))
        else:
            unused.append(block.label(column))
    layout = (
        "layout: wavelength and value"
        if block.width == 2
        else "layout: a column per spectrum"
    )
    return Table(
        series,
        block.remarks,
        (layout, *not_used_note(unused)),
        tuple(map(_skipped, others)),
    )


def _series(block: Block, column: int, axis: int, axes: dict[int, Array]) -> Series:
    """Return the spectrum of a column, at the wavelengths of the column ``axis``, one
    of the ``axes``.
    """
    nm = axes[axis]
    cells = block.cells(column)
    labels = block.labels(column)
    if len(axes) > 1:  # the name may stand above the wavelengths
        above = block.labels(axis)
        labels = [cell for cell in above if not names_wavelengths(cell.text)] + labels
    if block.heads and not labels:
        problem = f"column {column + 1} has values and no label"
        hint = "label it, and use another separator than the decimal comma"
        raise block.grid.location.at(cells[0].line).error(problem, hint)
    known = np.flatnonzero(np.isfinite(nm)).tolist()
    values = tuple(cells[row] for row in known)
    return Series(block.label(column), nm[known], values, _name(labels))


def _name(labels: Sequence[Cell]) -> Cell | None:
    """Return the label that names a sample: the lowest one, as it stands above quantity
    and unit; None for none.
    """
    names = [cell for cell in labels if not is_plain(cell.text)]
    long = [cell for cell in names if len(cell.text) > 1]
    return next(iter(long[-1:] or names), None)


def _skipped(block: Block) -> SkippedEntry:
    """Return the entry that stands for a further table of a file."""
    line = block.rows[0][0].line
    reason = "a file has one table: write it to another file"
    return SkippedEntry(f"lines from {line} on", reason, block.grid.location.path, line)


def _axes(block: Block) -> dict[int, Array]:
    """Return the wavelengths in nm of each column that has them, by its label or its
    numbers, NaN where a cell is empty.
    """
    axes = {block.column: block.nm}
    for column in range(block.column + 1, block.width):
        labels = [cell.text for cell in block.labels(column)]
        cells = [parse_cell(cell.text) for cell in block.cells(column)]
        nm = to_nm(np.array(cells, float), find_unit(" ".join(labels)) or block.unit)
        if are_wavelengths(nm, is_named=any(map(names_wavelengths, labels))):
            axes[column] = nm
    return axes


def pairs_of_lines(grid: Grid) -> Table | None:
    """Read a table with a spectrum on each line, perhaps behind its name."""
    series = list[Series]()
    remarks = list[str]()
    for row in grid.rows:
        if len(row) < PAIRS or not any(is_value(cell.text) for cell in row):
            remarks += line_texts([row])
            continue
        name = None if is_value(row[0].text) else row[0]
        cells = row if name is None else row[1:]
        nm = _wavelengths(cells, grid.unit or NANOMETRE)
        if nm is None or not (np.isfinite(nm).all() and are_wavelengths(nm)):
            return None
        series.append(Series(str(len(series) + 1), nm, cells[1::2], name))
    notes = ("layout: pairs, a line per spectrum",)
    return Table(series, remarks, notes) if series else None


def _pairs(block: Block) -> Series | None:
    """Return the spectrum whose wavelengths go on from pair to pair in equal steps, and
    then to the next line.
    """
    for cell in chain.from_iterable(block.heads):
        if not (is_plain(cell.text) or names_wavelengths(cell.text)):
            return None
    cells = tuple(chain.from_iterable(block.rows))
    nm = _wavelengths(cells, block.unit)
    if nm is None or block.width < PAIRS:
        return None
    have_equal_steps = np.ptp(np.diff(nm)) <= EQUAL  # not with NaN
    return Series("", nm, cells[1::2], None) if have_equal_steps else None


def _wavelengths(cells: Row, unit: float) -> Array | None:
    """Return the first numbers of pairs in nm; None for cells that are not pairs."""
    numbers = np.array(list(map(parse_cell, texts_of(cells))), float)
    first = numbers[::2]
    second = numbers[1::2]
    if len(first) != len(second) or not (second < SHORTEST).any():
        return None
    return to_nm(first, unit)
