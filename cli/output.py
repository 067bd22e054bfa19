"""Where tables go: as wide as the terminal, or wide enough for a pipe."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

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
