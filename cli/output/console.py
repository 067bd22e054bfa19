"""Standard output and standard error: the one door through which text reaches the
terminal.

Texts may come from files. `say`, `print_fields` and the cells of `make_table` escape
what a terminal would obey; `emit` prints text that is safe already; `print_json` and
`print_csv` print data.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import click

from uplift.common.text import json_escapes, printable

MIN_WIDTH = 40
"""Characters of a line, even where a window has fewer."""


def say(text: str = "", *, err: bool = False) -> None:
    """Print one line with control characters escaped."""
    emit(printable(text), err=err)


def emit(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Print text of our own, which may have several lines and colours."""
    click.echo(text, sys.stderr if err else sys.stdout, nl=nl)


def flush_stdout() -> None:
    """Write what standard output still holds, and drop it if that fails: the
    interpreter would try again at its end.
    """
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise


def window_width() -> int:
    """Return the characters of a line of the window, COLUMNS or 80."""
    return max(shutil.get_terminal_size().columns, MIN_WIDTH)


def has_colours() -> bool:
    """Return whether standard output shows colours."""
    is_plain = bool(os.environ.get("NO_COLOR")) or os.environ.get("TERM", "dumb") in (
        "dumb",
        "unknown",
    )
    return sys.stdout.isatty() and not is_plain


def paragraph(
    text: str, indent: int = 0, prefix: str = "", suffix: str = "", *, err: bool = False
) -> None:
    """Print prose with control characters escaped, wrapped to the window; words such as
    URLs stay whole.
    """
    lines = textwrap.wrap(
        printable(text),
        window_width() - indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
    emit(prefix + ("\n" + " " * indent).join(lines) + suffix, err=err)


def print_fields(
    fields: Mapping[str, str], patches: Mapping[str, str] | None = None
) -> None:
    """Print names and values in two columns, and the patches of values."""
    names = {name: printable(name) for name in fields}
    width = max(12, *(len(name) + 2 for name in names.values()))
    for name, text in fields.items():
        patch = patches.get(name, "") if patches else ""
        paragraph(text, width, f"{names[name]:<{width}}", patch and f"  {patch}")


def json_text(values: Any, indent: int | None = 2, *, ascii_only: bool = False) -> str:
    """Return standard JSON. Raises ValueError for NaN and infinity."""
    return json_escapes(
        json.dumps(values, indent=indent, ensure_ascii=ascii_only, allow_nan=False)
    )


def print_json(values: Any, indent: int | None = 2) -> None:
    """Print standard JSON, in the characters that standard output has."""
    emit(json_text(values, indent, ascii_only=not _has_unicode()))


def json_row(values: Any) -> str:
    """Return the JSON of one of many rows of finite numbers, which pydantic writes five
    times as fast.
    """
    if not _has_unicode():
        return json_text(values, indent=None, ascii_only=True)
    from pydantic_core import to_json

    return json_escapes(to_json(values).decode())


def _has_unicode() -> bool:
    return (sys.stdout.encoding or "utf-8").lower().startswith("utf")


def print_csv(rows: Iterable[Sequence[object]]) -> None:
    """Print rows as CSV, each before the next one is computed."""
    from uplift.extras.files.csv import write_csv

    write_csv(EscapedOutput(), rows)


class EscapedOutput:
    """Standard output with control characters escaped, but for the ends of lines."""

    def write(self, text: str) -> int:
        """Write lines."""
        return sys.stdout.write("\n".join(map(printable, text.split("\n"))))
