"""The schema of metadata: types and ranges of all JSON values.

Every query reads them, so the standard library has to do: pydantic would add a tenth to the start of a query.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from uplift.common.text import format_value, printable, shorten
from uplift.cube.container import require

__all__ = ["ENTRIES", "MAX_THRESHOLD", "METADATA", "MIN_THRESHOLD", "PROVENANCE", "check_metadata", "count", "text"]

MIN_THRESHOLD, MAX_THRESHOLD = 1e-12, 0.1
"""Linear RGB. Smaller distances are lost in the rounding of double precision."""
MAX_NUMBER = 1e30
MAX_TEXT = 1000
"""Characters of a name."""
MAX_ENTRIES = 1_000_000
MAX_FILES = 10_000
MAX_LIGHTS = 64
MAX_OPTIONS = 100

Schema = Any
"""A table of schemas by key, with ``?`` after optional keys and ``...`` where others may follow; or a check."""
Check = Callable[[Any, str], None]
"""Raises `CubeFileError` for a value that does not fit; the text is its key path."""


def check_metadata(metadata: Mapping[str, Any], schema: Schema) -> None:
    """Raise `CubeFileError` for the first value that does not fit, by its key path; names of entries are unique."""
    _check(metadata, schema, "")
    names = metadata["entries"]
    require(len(set(names)) == len(names), "the names of entries must be unique")


def text(value: Any, path: str) -> None:
    """Check a text."""
    _fits(isinstance(value, str) and len(value) <= MAX_TEXT, value, path, f"text of at most {MAX_TEXT} characters")


def count(value: Any, path: str) -> None:
    """Check a whole number from 0."""
    is_int = isinstance(value, int) and not isinstance(value, bool)
    _fits(is_int and 0 <= value <= MAX_NUMBER, value, path, "a whole number from 0")


@dataclass(frozen=True)
class Number:
    """Check of a number in [low, high]."""

    low: float = -MAX_NUMBER
    high: float = MAX_NUMBER

    def __call__(self, value: Any, path: str) -> None:
        """Check a value."""
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        constraint = f"a number in [{self.low:g}, {self.high:g}]"
        _fits(is_number and self.low <= value <= self.high, value, path, constraint)


@dataclass(frozen=True)
class ListOf:
    """Check of a list of at most ``limit`` items, each of a schema."""

    item: Schema
    limit: int

    def __call__(self, value: Any, path: str) -> None:
        """Check a value."""
        fits = isinstance(value, list) and len(value) <= self.limit
        _fits(fits, value, path, f"a list of at most {self.limit:,} items")
        for number, each in enumerate(value):
            _check(each, self.item, f"{path}[{number}]")


def options(value: Any, path: str) -> None:
    """Check the form of options; their ranges are checked where a build is repeated."""
    fits = isinstance(value, dict) and len(value) <= MAX_OPTIONS
    _fits(fits, value, path, f"a table of at most {MAX_OPTIONS} options")
    for key, each in value.items():
        text(key, path)
        if isinstance(each, list):
            ListOf(text, MAX_LIGHTS if key == "lights" else MAX_FILES)(each, _join(path, key))
        elif not isinstance(each, bool):
            check: Check = text if isinstance(each, str) else Number()
            check(each, _join(path, key))


def _check(value: Any, schema: Schema, path: str) -> None:
    if not isinstance(schema, dict):
        schema(value, path)
        return
    _fits(isinstance(value, dict), value, path, "a table")
    known = {key.removesuffix("?"): each for key, each in schema.items() if key != "..."}
    for key in known:
        require(key in value or f"{key}?" in schema, f"'{_join(path, key)}' is missing")
    for key, each in value.items():
        require(key in known or "..." in schema, f"unknown key '{_join(path, key)}'")
        if key in known:
            _check(each, known[key], _join(path, key))


def _join(path: str, key: str) -> str:
    key = shorten(printable(key))
    return f"{path}.{key}" if path else key


def _fits(condition: bool, value: object, path: str, constraint: str) -> None:
    require(condition, f"{path} must be {constraint}, got {format_value(value)}")


ENTRIES = ListOf(text, MAX_ENTRIES)
RGB = ListOf(Number(), 3)
FILE = {"name": text, "digest": text}
LIGHT = {"light": text, "wish": RGB, "answer": RGB, "delta_e": Number(0), "possible": Number(0)}
LOOK = {"name": text, "rgb": RGB, "weight": Number(0, 1), "lights": ListOf(LIGHT, MAX_LIGHTS)}
PROVENANCE = {
    "uplift?": text,
    "options?": options,
    "atlases?": ListOf({**FILE, "measured?": text}, MAX_FILES),
    "libraries?": ListOf(FILE, MAX_FILES),
    "families?": ListOf({"name": text, "relevance": Number()}, MAX_FILES),
    "looks?": ListOf(LOOK, MAX_FILES),
    "left_out?": ENTRIES,
    "skipped?": ENTRIES,
    "prior?": {"length?": Number(0), "nugget?": Number(0), "error_bound?": Number(0), "...": None},
    "improvements?": ListOf({"step": text, "tried": count, "mended": count}, MAX_FILES),
    "scene?": ListOf({"...": None}, MAX_FILES),
    "filled?": {"points": count, "cube": text},
    "...": None,
}
MODEL = {
    "name": text,
    "count?": count,
    "phase?": {"start": Number(), "end": Number(), "warp": text},
    "start?": Number(),
    "end?": Number(),
}
METADATA = {
    "format": text,
    "version": count,
    "features": ListOf(text, MAX_OPTIONS),
    "model": MODEL,
    "entry_model": MODEL,
    "dim": count,
    "space": text,
    "illuminant": text,
    "observer": text,
    "threshold": Number(MIN_THRESHOLD, MAX_THRESHOLD),
    "reference": text,
    "entries": ENTRIES,
    "provenance": PROVENANCE,
}
