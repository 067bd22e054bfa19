"""Tables whose texts come from files and that fit any window; imported when a table is printed, as it loads rich.

A table that is wider than the window is folded: the numbers of a row continue on further lines, as their headings do.
Where that does not suffice, each row becomes a block with a line for every cell. No cell is cut.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest
from typing import Any

from rich.cells import cell_len
from rich.console import RenderableType
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

from uplift.common.text import printable

WRAPPED = 28
"""Characters that a column of wrapped text has at least, if its text is that long."""
GAP = 2
"""Characters between columns."""
LAYOUT: dict[str, Any] = {
    "padding": (0, 1),
    "collapse_padding": True,
    "pad_edge": False,
    "show_edge": False,
    "title_justify": "left",
    "caption_justify": "left",
}
"""Options of every table."""


class SafeTable(Table):
    """A table that shows its texts as they are: no markup, and control characters escaped."""

    def __init__(self, *, title: str | None = None, caption: str | None = None, **options: Any) -> None:
        super().__init__(
            title=None if title is None else plain(title),
            caption=None if caption is None else plain(caption),
            **LAYOUT | options,
        )

    def add_column(self, header: Any = "", *args: Any, **options: Any) -> None:
        """Add a column with a heading of text."""
        super().add_column(plain(header), *args, **options)

    def add_row(self, *cells: Any, **options: Any) -> None:
        """Add a row of texts."""
        super().add_row(*map(plain, cells), **options)

    def fitted(self, width: int) -> RenderableType:
        """Return this table, or one with the same cells that is not wider than ``width`` characters."""
        numbers = sum(column.justify == "right" for column in self.columns[1:])
        for lines in range(1, max(numbers, 1) + 1):
            table = self if lines == 1 else self._folded(lines)
            if table.needed_width <= width:
                return table
        return self._blocks(width)

    @property
    def needed_width(self) -> int:
        """Characters of the table, with columns of long texts wrapped."""
        return sum(_needed(column) for column in self.columns) + GAP * (len(self.columns) - 1)

    def _folded(self, lines: int) -> SafeTable:
        """Return the table with the numbers after its first column on several lines of each row."""
        texts = [self.columns[0], *(column for column in self.columns[1:] if column.justify != "right")]
        numbers = [column for column in self.columns[1:] if column.justify == "right"]
        count = -(-len(numbers) // lines)
        groups = [numbers[first : first + count] for first in range(0, len(numbers), count)]
        folded = [_stacked(each) for each in zip_longest(*groups)]
        return self._with_columns([*texts, *folded], spaced=True)

    def _with_columns(self, columns: Sequence[Column], *, spaced: bool) -> SafeTable:
        table = SafeTable(box=self.box, show_header=self.show_header)
        table.title, table.caption = self.title, self.caption
        for column in columns:
            table.add_column(column.header, justify=column.justify, no_wrap=column.no_wrap, overflow=column.overflow)
        cells = [list(column.cells) for column in columns]
        for number, row in enumerate(self.rows):
            end = row.end_section or (spaced and number < len(self.rows) - 1)
            table.add_row(*(each[number] for each in cells), style=row.style, end_section=end)
        return table

    def _blocks(self, width: int) -> RenderableType:
        """Return a block for each row: its first texts, and below them a line for every other cell."""
        from rich.console import Group

        first = next((number for number, column in enumerate(self.columns) if str(column.header)), 0)
        heads = [*range(first + 1)]
        while heads[-1] + 1 < len(self.columns) and not str(self.columns[heads[-1] + 1].header):
            heads.append(heads[-1] + 1)
        cells = [list(column.cells) for column in self.columns]
        rest = range(heads[-1] + 1, len(self.columns))
        names = max((cell_len(str(self.columns[number].header)) for number in rest), default=0)
        parts: list[RenderableType] = [text for text in (self.title, self.caption) if text]
        for row in range(len(self.rows)):
            head = Text("  ").join([_text(cells[number][row]) for number in heads])
            head.stylize("bold")
            parts.append(head)
            grid = Table.grid(padding=(0, GAP, 0, 0), pad_edge=False)
            grid.add_column(width=names, no_wrap=True)
            grid.add_column(overflow="fold", max_width=width - names - 2 * GAP)
            for number in rest:
                if str(cells[number][row]):
                    grid.add_row(self.columns[number].header, cells[number][row])
            if grid.rows:
                parts.append(Padding(grid, (0, 0, 0, GAP), expand=False))
        return Group(*parts)


def _needed(column: Column) -> int:
    natural = max(_lengths(column), default=0)
    return natural if column.no_wrap or column.justify == "right" else min(natural, WRAPPED)


def _lengths(column: Column) -> Iterator[int]:
    for cell in (column.header, *column.cells):
        yield max((cell_len(line) for line in str(cell).split("\n")), default=0)


def _stacked(columns: Iterable[Column | None]) -> Column:
    """Return a column whose cells have those of several columns below one another."""
    given = list(columns)
    headers = [_text(column.header if column else "") for column in given]
    rows = zip_longest(*(column.cells if column else () for column in given), fillvalue="")
    stacked = Column(header=Text("\n").join(headers), justify="right", no_wrap=True)
    stacked._cells = [Text("\n").join(map(_text, cells)) for cells in rows]
    return stacked


def _text(cell: Any) -> Text:
    return cell if isinstance(cell, Text) else Text(str(cell))


def plain(text: str | Text) -> Text:
    """Return text that rich shows as it is; the style of a `Text` stays."""
    if isinstance(text, str):
        return Text(printable(text))
    safe = "\n".join(map(printable, text.plain.split("\n")))
    return text if safe == text.plain else Text(safe, style=text.style)
