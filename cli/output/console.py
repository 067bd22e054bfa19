"""Tables and JSON on standard output."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

PIPE_WIDTH = 160
"""Width of tables that do not go to a terminal, in characters."""


def console() -> Console:
    """Return a rich console on standard output."""
    from rich.console import Console

    console = Console(file=sys.stdout, highlight=False)
    if not console.is_terminal:
        console.width = max(console.width, PIPE_WIDTH)
    return console


def make_table(texts: Iterable[str], numbers: Iterable[str], **options: Any) -> Table:
    """Return a table with left-aligned columns of text followed by right-aligned columns of numbers."""
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, **options)
    for heading in texts:
        table.add_column(heading, no_wrap=True)
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def json_text(values: Any, indent: int | None = 2) -> str:
    """Return standard JSON. Raises ValueError for NaN and infinity, which it cannot represent."""
    return json.dumps(values, indent=indent, ensure_ascii=False, allow_nan=False)
