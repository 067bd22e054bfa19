"""What a fit tells whoever watches it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Round:
    """Points tried at a time in a round of growth, fitted so far, and in all."""

    number: int
    tried: int
    fitted: int
    total: int


@dataclass(frozen=True)
class Storing:
    """Points whose coefficients are stored and judged so far, and in all."""

    stored: int
    total: int


Watch = Callable[[Round | Storing], None]
