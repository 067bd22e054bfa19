"""Standard output and standard error: the one door through which text reaches the terminal.

Texts may come from files. `say` and the cells of `make_table` escape what a terminal would obey; `emit` prints text
that is safe already; `print_json` and `print_csv` print data.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import textwrap
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import json_escapes, printable

if TYPE_CHECKING:
    from rich.console import Console

    from uplift.common.csv import CsvWriter

    from .tables import SafeTable

MIN_WIDTH = 40
"""Characters of a line, even where a window has fewer."""


def say(text: str = "", *, err: bool = False) -> None:
    """Print one line with control characters escaped."""
    emit(printable(text), err=err)


def emit(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Print text of our own, which may have several lines and colours."""
    click.echo(text, sys.stderr if err else sys.stdout, nl=nl)


def flush_stdout() -> None:
    """Write what standard output still holds, and drop it if that fails: the interpreter would try again at its end."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise


def paragraph(text: str) -> None:
    """Print prose with control characters escaped, wrapped to the window."""
    emit(textwrap.fill(printable(text), columns(), break_long_words=False, break_on_hyphens=False))


def json_text(values: Any, indent: int | None = 2) -> str:
    """Return standard JSON. Raises ValueError for NaN and infinity, which it cannot represent."""
    return json_escapes(json.dumps(values, indent=indent, ensure_ascii=False, allow_nan=False))


def terminal_json(values: Any, indent: int | None = None) -> str:
    """Return standard JSON, in the characters that standard output has."""
    text = json_text(values, indent)
    is_unicode = (sys.stdout.encoding or "utf-8").lower().startswith("utf")
    return text if is_unicode else json.dumps(json.loads(text), indent=indent)


def print_json(values: Any, indent: int | None = 2) -> None:
    """Print standard JSON."""
    emit(terminal_json(values, indent))


def print_json_answers(objects: Iterable[Any], *, single: bool) -> None:
    """Print one object on a line, or else an array, each object before the next one is computed."""
    if single:
        print_json(next(iter(objects)), indent=None)
        return
    for number, values in enumerate(objects):
        emit(("[\n" if number == 0 else ",\n") + terminal_json(values), nl=False)
    emit("\n]")


def csv_writer() -> CsvWriter:
    """Return a writer of CSV to standard output."""
    from uplift.common.csv import CsvWriter

    return CsvWriter(_Lines())


def print_csv(header: Sequence[object], rows: Iterable[Sequence[object]]) -> None:
    """Print a table as CSV."""
    writer = csv_writer()
    for row in (header, *rows):
        writer.write(row)


def print_csv_text(text: str) -> None:
    """Print CSV."""
    _Lines().write(text)


class _Lines:
    """Standard output with control characters escaped, but for the ends of lines."""

    def write(self, text: str) -> int:
        sys.stdout.write("\n".join(map(printable, text.split("\n"))))
        return len(text)


def columns() -> int:
    """Return the characters of a line of the window, COLUMNS or 80."""
    return max(shutil.get_terminal_size().columns, MIN_WIDTH)


def console() -> Console:
    """Return a rich console on standard output."""
    from rich.console import Console

    return Console(file=sys.stdout, width=columns(), highlight=False, markup=False, emoji=False)


def has_colours() -> bool:
    """Return whether standard output shows colours."""
    return console().color_system is not None


def make_table(texts: Iterable[str] = (), numbers: Iterable[str] = (), **options: Any) -> SafeTable:
    """Return a table with left-aligned columns of text followed by right-aligned columns of numbers."""
    from rich import box

    from .tables import SafeTable

    table = SafeTable(**{"box": box.SIMPLE_HEAD} | options)
    for heading in texts:
        table.add_column(heading, no_wrap=True)
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def show(*tables: SafeTable) -> None:
    """Print tables. Texts are wrapped to the window; rows whose names and numbers do not fit are longer than a line."""
    out = console()
    for number, table in enumerate(tables):
        if number:
            out.print()
        out.width = max(columns(), table.narrowest())
        out.print(table)
