"""Tables whose texts come from files; imported when a table is printed, as it loads rich."""

from __future__ import annotations

from typing import Any

from rich.table import Table
from rich.text import Text

from uplift.common.text import printable


class SafeTable(Table):
    """A table that shows its texts as they are: no markup, and control characters escaped."""

    def __init__(self, *, title: str | None = None, caption: str | None = None, **options: Any) -> None:
        super().__init__(
            title=None if title is None else plain(title),
            caption=None if caption is None else plain(caption),
            **options,
        )

    def add_column(self, header: Any = "", *args: Any, **options: Any) -> None:
        """Add a column with a heading of text."""
        super().add_column(plain(header), *args, **options)

    def add_row(self, *cells: Any, **options: Any) -> None:
        """Add a row of texts."""
        super().add_row(*map(plain, cells), **options)


def plain(text: str | Text) -> Text:
    """Return text that rich shows as it is; the style of a `Text` stays."""
    if isinstance(text, str):
        return Text(printable(text))
    safe = printable(text.plain)
    return text if safe == text.plain else Text(safe, style=text.style)
