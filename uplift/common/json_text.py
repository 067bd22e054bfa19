"""JSON text of unknown origin: finite numbers, valid Unicode, limited size and nesting."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from typing import Any

__all__ = ["TOO_DEEP", "InvalidJsonError", "check_values", "parse_json"]

MAX_DEPTH = 32
"""Deepest nesting of tables and lists."""
TOO_DEEP = f"tables and lists must not nest more than {MAX_DEPTH} levels deep"
MAX_VALUES = 2_000_000
"""Values of a file, tables and lists included."""


class InvalidJsonError(ValueError):
    """A text that is not JSON, or exceeds a limit.

    Parameters
    ----------
    problem : str
        The constraint and the value received.
    code : str
        Code of the `UpliftError` that is raised in the end.
    line : int, optional
        Line of the text, counted from 1.
    """

    def __init__(self, problem: str, *, code: str, line: int | None = None) -> None:
        super().__init__(problem)
        self.problem, self.code, self.line = problem, code, line


def parse_json(text: str) -> Any:
    """Parse JSON.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    object
        Its value.

    Raises
    ------
    InvalidJsonError
        The text is not JSON (``invalid-json``), contains a number that is not finite or text that is not valid Unicode
        (``invalid-json``), or exceeds a limit (see `check_values`).
    """
    try:
        value = json.loads(text, parse_constant=_finite, parse_float=_finite)
        check_values(value)
    except InvalidJsonError:
        raise
    except RecursionError:
        raise InvalidJsonError(TOO_DEEP, code="nesting-too-deep") from None
    except ValueError as error:  # JSONDecodeError, and integers of too many digits
        raise InvalidJsonError(str(error), code="invalid-json", line=getattr(error, "lineno", None)) from None
    return value


def check_values(value: object) -> None:
    """Check the values of a parsed file. Deep nesting would exhaust the stack of recursive code.

    Parameters
    ----------
    value : object
        Tables, lists, text and numbers.

    Raises
    ------
    InvalidJsonError
        They nest more than `MAX_DEPTH` levels (``nesting-too-deep``), are more than `MAX_VALUES`
        (``too-many-values``), or contain text that is not valid Unicode (``invalid-json``).
    """
    level, count = [value], 0
    for _ in range(MAX_DEPTH + 1):
        count += len(level)
        if count > MAX_VALUES:
            raise InvalidJsonError(f"must not have more than {MAX_VALUES:,} values", code="too-many-values")
        for each in level:
            _check_text(each)
        level = [child for each in level for child in _children(each)]
        if not level:
            return
    raise InvalidJsonError(TOO_DEEP, code="nesting-too-deep")


def _check_text(value: object) -> None:
    for text in value if isinstance(value, dict) else (value,):
        if isinstance(text, str) and not _is_unicode(text):
            raise InvalidJsonError(f"text must be valid Unicode, got {text[:40]!a}", code="invalid-json")


def _is_unicode(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:  # lone surrogates
        return False
    return True


def _children(value: object) -> Iterable[Any]:
    if isinstance(value, dict):
        return value.values()
    return value if isinstance(value, list) else ()


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"numbers must be finite, got {text[:40]}")
    return value
