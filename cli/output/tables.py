"""Tables whose texts come from files; imported when needed, as it loads rich."""

import copy
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

from rich.cells import cell_len
from rich.table import Column, Table
from rich.text import Text

from uplift.common.text import printable

LAYOUT: dict[str, Any] = {
    "padding": (0, 1),
    "collapse_padding": True,
    "pad_edge": False,
    "show_edge": False,
    "title_justify": "left",
    "caption_justify": "left",
}
"""Options of every table."""
WRAPPED = 16
"""Characters that a column of wrapped text has at least, if its text is that long."""
LONG = 1000
"""Rows from which a table of plain texts is printed without rich."""
GAP = 2
"""Characters between columns."""
MAX_KEYS = 3
"""Columns of text that every part of a wide table begins with, in at most half of the
window.
"""


class SafeTable(Table):
    """A table that shows its texts without markup, control characters escaped."""

    def __init__(
        self, *, title: str | None = None, caption: str | None = None, **options: Any
    ) -> None:
        super().__init__(
            title=title and plain(title),
            caption=caption and plain(caption),
            **LAYOUT | options,
        )

    def add_column(self, header: Any = "", *args: Any, **options: Any) -> None:
        """Add a column, wrapped between words unless it is ``no_wrap``."""
        super().add_column(plain(header), *args, **{"overflow": "fold"} | options)

    def add_row(self, *cells: Any, **options: Any) -> None:
        """Add a row of texts."""
        super().add_row(*map(plain, cells), **options)

    def parts(self, width: int) -> Iterator["SafeTable"]:
        """Divide the columns of a table that is wider than a window; the first ones are
        repeated in every part.
        """
        for column in self.columns:
            column.min_width = narrowest(column)
        keys = self._keys(width)
        columns = list(keys)
        caption = self.caption
        self.caption = None
        for column in self.columns[len(keys) :]:
            if len(columns) > len(keys) and table_width([*columns, column]) > width:
                yield self._with_columns(columns)
                columns = list(keys)
                self.title = None
            columns.append(column)
        self.caption = caption
        yield self._with_columns(columns)

    def take_body(self) -> Iterator[str]:
        """Take the rows out of a long table of plain texts, and yield their lines: rich
        needs a third of a millisecond for each.
        """
        rows = list(zip(*(column.cells for column in self.columns), strict=True))
        has_styles = any(isinstance(cell, Text) for cell in chain.from_iterable(rows))
        are_lines = all(column.no_wrap for column in self.columns)
        if len(rows) >= LONG and are_lines and not has_styles:
            for column in self.columns:
                column._cells = []
            for row in rows:
                yield (" " * GAP).join(map(_aligned, row, self.columns)).rstrip()

    def _keys(self, width: int) -> Sequence[Column]:
        count = 1
        while (
            count < min(MAX_KEYS, len(self.columns) - 1)
            and self.columns[count].justify == "left"
            and table_width(self.columns[: count + 1]) <= width / 2
        ):
            count += 1
        return self.columns[:count]

    def _with_columns(self, columns: Sequence[Column]) -> "SafeTable":
        table = copy.copy(self)
        table.columns = [
            replace(column, _index=index) for index, column in enumerate(columns)
        ]
        return table


def _aligned(text: str, column: Column) -> str:
    """Return a cell as wide as its column."""
    missing = " " * ((column.min_width or 0) - cell_len(text))
    return missing + text if column.justify == "right" else text + missing


def narrowest(column: Column) -> int:
    """Return the characters of a column whose texts are wrapped between words."""
    texts = [str(cell) for cell in (column.header, *column.cells)]
    natural = max(map(cell_len, texts))
    if column.no_wrap:
        return natural
    words = chain.from_iterable(map(str.split, texts))
    longest_word = max(map(cell_len, words), default=0)
    return max(longest_word, min(natural, WRAPPED))


def table_width(columns: Sequence[Column]) -> int:
    """Return the characters of a table of these columns, as narrow as possible."""
    return sum(map(narrowest, columns)) + GAP * (len(columns) - 1)


def plain(text: str | Text) -> str | Text:
    """Return text without control characters; the style of a `Text` stays."""
    if isinstance(text, str):
        return printable(text)
    safe = "\n".join(map(printable, text.plain.split("\n")))
    return text if safe == text.plain else Text(safe, style=text.style)
