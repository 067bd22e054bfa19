"""Tables whose texts come from files; imported when a table is printed, as it loads rich."""

from typing import Any

from rich.cells import cell_len
from rich.table import Table
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
GAP = 2
"""Characters between columns."""


class SafeTable(Table):
    """A table that shows its texts as they are: no markup, and control characters escaped."""

    def __init__(self, *, title: str | None = None, caption: str | None = None, **options: Any) -> None:
        super().__init__(title=title and plain(title), caption=caption and plain(caption), **LAYOUT | options)

    def add_column(self, header: Any = "", *args: Any, **options: Any) -> None:
        """Add a column with a heading of text. Long words are folded, unless ``no_wrap`` keeps cells on one line."""
        super().add_column(plain(header), *args, **{"overflow": "fold"} | options)

    def add_row(self, *cells: Any, **options: Any) -> None:
        """Add a row of texts."""
        super().add_row(*map(plain, cells), **options)

    def narrowest(self) -> int:
        """Return the characters of the table with its texts wrapped."""
        widths = []
        for column in self.columns:
            natural = max(cell_len(str(cell)) for cell in (column.header, *column.cells))
            widths.append(natural if column.no_wrap else min(natural, WRAPPED))
        return sum(widths) + GAP * (len(widths) - 1)


def plain(text: str | Text) -> Text:
    """Return text that rich shows as it is; the style of a `Text` stays."""
    if isinstance(text, str):
        return Text(printable(text))
    safe = "\n".join(map(printable, text.plain.split("\n")))
    return text if safe == text.plain else Text(safe, style=text.style)
