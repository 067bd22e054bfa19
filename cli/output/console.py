"""Tables and JSON on standard output."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

PIPE_WIDTH = 160
"""Width of tables that do not go to a terminal, in characters."""


def console() -> Console:
    """Return a rich console on standard output."""
    from rich.console import Console

    console = Console(file=sys.stdout, highlight=False)
    if not console.is_terminal:
        console.width = max(console.width, PIPE_WIDTH)
    return console


def json_text(values: Any, indent: int | None = 2) -> str:
    """Return standard JSON. Raises ValueError for NaN and infinity, which it cannot represent."""
    return json.dumps(values, indent=indent, ensure_ascii=False, allow_nan=False)
