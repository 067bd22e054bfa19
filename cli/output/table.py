"""The table of a command: rows that are printed as text, CSV or JSON."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import chain
from numbers import Real
from typing import TYPE_CHECKING, Any

from uplift.common.text import printable

from .console import (
    emit,
    has_colours,
    json_row,
    paragraph,
    print_csv,
    print_json,
    say,
    window_width,
)

if TYPE_CHECKING:
    from rich.text import Text

Row = Mapping[str, Any]
Format = str | Callable[[Any], Any]
"""A format of numbers, or a function that returns the text of a cell."""
GAP = 2
"""Characters between columns."""
UNKNOWN = "–"
"""Cell without a value."""


@dataclass(frozen=True)
class Table:
    """Rows with equal keys.

    CSV has all keys; a list of numbers has a column for each letter of its key, such as
    ``rgb``. Text has the columns of ``headings``, by their keys and in this order;
    numbers are right-aligned, and a list of numbers is one cell. A value has the format
    of its key, or a function's text, or else ``digits`` if it is a float.
    """

    rows: Iterable[Row]
    headings: Mapping[str, str] = field(default_factory=dict)
    title: str = ""
    digits: str = ".3f"
    formats: Mapping[str, Any] = field(default_factory=dict)

    def print_csv(self) -> None:
        """Print CSV, each row before the next one is computed."""
        rows = map(_flat, self.rows)
        first = next(rows, None)
        if first is not None:
            cells = (list(row.values()) for row in chain([first], rows))
            print_csv(chain([list(first)], cells))

    def print_text(self) -> None:
        """Print a table as wide as the window at most, unless its numbers and words are
        wider. Texts are wrapped between words.
        """
        from rich import box
        from rich.cells import cell_len
        from rich.console import Console
        from rich.table import Table as Drawing

        drawing = Drawing(
            box=box.SIMPLE_HEAD, collapse_padding=True, pad_edge=False, show_edge=False
        )
        rows = list(self.rows)
        least = 0
        columns = []
        for key, heading in self.headings.items():
            values = [row[key] for row in rows]
            cells = [self._cell(key, value) for value in values]
            columns.append(cells)
            is_number = all(isinstance(value, Real | None) for value in values)
            is_list = any(isinstance(value, list) for value in values)
            texts = list(map(str, cells))
            words = list(chain.from_iterable(map(str.split, texts)))
            no_wrap = is_list or words == texts
            least += GAP + max(map(cell_len, [heading, *(texts if no_wrap else words)]))
            drawing.add_column(
                printable(heading),
                justify="right" if is_number else "left",
                no_wrap=no_wrap,
                overflow="fold",
            )
        for row in zip(*columns, strict=True):
            drawing.add_row(*row)
        if self.title:
            paragraph(self.title)
        Console(
            file=sys.stdout,
            width=max(window_width(), least),
            highlight=False,
            markup=False,
            emoji=False,
        ).print(drawing)

    def _cell(self, key: str, value: Any) -> str | Text:
        form = self.formats.get(key, self.digits)
        if value is None:
            return UNKNOWN
        if callable(form):
            cell = form(value)
            return printable(cell) if isinstance(cell, str) else cell
        if isinstance(value, list):
            return " ".join(str(self._cell(key, part)) for part in value)
        if isinstance(value, float) or key in self.formats:
            return format(value, form)
        if isinstance(value, int):
            return f"{value:,}"
        return printable(value) if isinstance(value, str) else value


def _flat(row: Row) -> dict[str, Any]:
    """Return a row whose values are the cells of CSV."""
    cells: dict[str, Any] = {}
    for key, value in row.items():
        if isinstance(value, bool):
            cells[key] = str(value).lower()
        elif not isinstance(value, list):
            cells[key] = value
        elif all(isinstance(part, str) for part in value):
            cells[key] = "; ".join(value)
        else:
            cells |= zip(key, value, strict=True)
    return cells


def swatch(code: str, text: str = "") -> Text:
    """Return a cell with a patch of a colour '#rrggbb' before the text, where standard
    output shows colours.
    """
    from rich.text import Text

    if not has_colours():
        return Text(printable(text))
    return Text("    ", style=f"on {code}").append(f" {printable(text)}", style="none")


def print_result(style: str, data: Any, *tables: Table) -> None:
    """Print ``data`` as JSON, or tables as CSV or text."""
    if style == "json":
        print_json(data)
    elif style == "csv":
        for table in tables:
            table.print_csv()
    else:
        for number, table in enumerate(tables):
            if number:
                say()
            table.print_text()


def print_json_rows(rows: Iterable[Row], *, single: bool) -> None:
    """Print a single row as a JSON object, or else an array of rows, each before the
    next one is computed.
    """
    if single:
        (row,) = rows
        print_json(row, indent=None)
        return
    before = "[\n"
    for row in rows:
        sys.stdout.write(before + json_row(row))
        before = ",\n"
    emit("\n]")
