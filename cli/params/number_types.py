"""Numbers of options: finite, in a range, in ASCII digits."""

from __future__ import annotations

import math
from typing import Any

import click

from uplift.common.text import format_value, parse_float, parse_whole

LARGEST = 10**9
"""Default limit of whole numbers; the library has smaller ones."""


class Number(click.ParamType):  # type: ignore[type-arg]
    """A finite number; the library checks its range."""

    name = "float"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return a finite number."""
        try:
            number = parse_float(value) if isinstance(value, str) else float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            self.fail(f"{format_value(value)} is not a finite number.", param, ctx)
        return number


class Whole(click.IntRange):
    """A whole number in a range."""

    def __init__(self, low: int | None = None, high: int = LARGEST) -> None:
        super().__init__(low, high)

    def _describe_range(self) -> str:
        """Return the range that the help shows, without the default limit."""
        if self.max != LARGEST:
            return super()._describe_range()
        return "" if self.min is None else f"x>={self.min}"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return a whole number."""
        try:
            number = parse_whole(value) if isinstance(value, str) else value
        except ValueError:
            self.fail(f"{format_value(value)} is not a whole number.", param, ctx)
        if self.max == LARGEST and number > LARGEST:
            self.fail(f"{format_value(value)} is greater than {LARGEST}.", param, ctx)
        return super().convert(number, param, ctx)


NUMBER = Number()
