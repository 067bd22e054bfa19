"""What is printed: tables as wide as the terminal, or wide enough for a pipe; JSON of numbers that all readers know."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

PIPE_WIDTH = 160
"""Columns of a table that no terminal limits."""


def console() -> Console:
    """A rich console on standard output."""
    from rich.console import Console

    found = Console(file=sys.stdout, highlight=False)
    if not found.is_terminal:
        found.width = max(found.width, PIPE_WIDTH)
    return found


def json_text(values: Any, indent: int | None = 2) -> str:
    """JSON, which has no NaN and no infinity. Raises ValueError for these."""
    return json.dumps(values, indent=indent, ensure_ascii=False, allow_nan=False)
