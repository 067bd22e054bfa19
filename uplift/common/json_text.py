"""JSON text of unknown origin: finite numbers, valid Unicode, limited size and nesting."""

from __future__ import annotations

import json
import math
from typing import Any

__all__ = ["check_values", "parse_json"]

MAX_DEPTH = 32
"""Deepest nesting of tables and lists."""
TOO_DEEP = f"tables and lists must not nest more than {MAX_DEPTH} levels deep"
MAX_VALUES = 2_000_000
"""Values and keys of a file, tables and lists included."""


def parse_json(text: str) -> Any:
    """Parse JSON; `ValueError` for text that is not JSON, not finite, not Unicode, or beyond the limits."""
    try:
        value = json.loads(text, parse_constant=_finite, parse_float=_finite)
    except RecursionError:
        raise ValueError(TOO_DEEP) from None
    check_values(value)
    return value


def check_values(value: object) -> None:
    """Raise `ValueError` if parsed values nest too deeply for recursive code, are too many, or have lone surrogates."""
    level, count = [value], 0
    for _ in range(MAX_DEPTH + 1):
        count += len(level)
        if count > MAX_VALUES:
            raise ValueError(f"must not have more than {MAX_VALUES:,} values")
        children: list[Any] = []
        for each in level:
            if isinstance(each, dict):
                children += each.keys()
                children += each.values()
            elif isinstance(each, list):
                children += each
            elif isinstance(each, str):
                each.encode()  # raises ValueError for lone surrogates
        if not children:
            return
        level = children
    raise ValueError(TOO_DEEP)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"numbers must be finite, got {text[:40]}")
    return value
