"""A grid of cells of a file, and the spectra that are found in it."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from uplift.atlas.atlas import SkippedEntry
from uplift.atlas.document import SourceLocation
from uplift.common.arrays import Array
from uplift.extras.formats.quantities import TABLE
from uplift.extras.formats.statements import remark_unit
from uplift.extras.formats.tables.cells import Cell, Row, line_texts

LAYOUT = "write a header row of wavelengths in nm and a row per entry, or the transpose"
MAX_PREAMBLE = 1000
"""Rows among which the row of wavelengths is searched."""
MAX_HEADS = 4
"""Rows of labels above columns."""
MAX_AXIS = 3
"""Columns among which that of the wavelengths is searched."""
NAME_LABELS = tuple(TABLE["words"]["names"])


class Series(NamedTuple):
    """The cells of one spectrum, their wavelengths in nm, what their label states, and
    the cell of the name if any.
    """

    label: str
    nm: Sequence[float] | Array
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
    may_group: bool = False
    """Whether commas in numbers may be those of thousands."""

    @cached_property
    def unit(self) -> float | None:
        """Unit of wavelengths that a line of text states, see `find_unit`."""
        return remark_unit([*self.comments, *line_texts(self.rows[:MAX_PREAMBLE])])

    def column(self, column: int) -> Row:
        """Return a column; rows that do not reach it have a text there."""
        return tuple(
            row[column] if column < len(row) else Cell("short", row[0].line)
            for row in self.rows
        )

    def remarks(self, first: int, last: int | None = None) -> list[str]:
        """Return the comments, and the lines before row ``first`` and from row ``last``
        on.
        """
        below = [] if last is None else line_texts(self.rows[last:])
        return [*self.comments, *line_texts(self.rows[:first]), *below]


def plain_label(text: str) -> str:
    """Return a label in lower case without units, scales, blanks and punctuation."""
    return re.sub(r"[(\[].*|[\s_.%-]", "", text.casefold())


def cell_at(row: Row, column: int) -> Cell:
    """Return a cell of a row, empty beyond its end."""
    return row[column] if column < len(row) else Cell("", row[0].line)
