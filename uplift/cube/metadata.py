"""The schema of a cube's metadata.

Every query reads them, so the standard library has to do: pydantic would add a tenth to the start of a query.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from uplift.common.errors import CubeFileError
from uplift.common.text import format_value, shorten

__all__ = ["MAX_THRESHOLD", "MIN_THRESHOLD", "check_emission_metadata", "check_metadata"]

MIN_THRESHOLD, MAX_THRESHOLD = 1e-12, 0.1
"""Linear RGB. Smaller distances are lost in the rounding of double precision."""
MAX_NUMBER = 1e30
MAX_TEXT = 1000
"""Characters of a name."""
MAX_ENTRIES = 1_000_000
MAX_FILES = 10_000
MAX_LIGHTS = 64
MAX_OPTIONS = 100

Check = Callable[[Any, str], None]
"""Raises `CubeFileError` for a value that does not fit; the text is its key path."""


def check_metadata(metadata: Mapping[str, Any]) -> None:
    """Check types and ranges of all metadata.

    Parameters
    ----------
    metadata : mapping
        JSON values without the digest.

    Raises
    ------
    CubeFileError
        The first value that does not fit (``invalid-metadata``), by its key path.
    """
    METADATA(metadata, "")
    _require_unique(metadata["entries"])


def check_emission_metadata(metadata: Mapping[str, Any]) -> None:
    """Check types and ranges of all metadata of an emission table, as `check_metadata` does.

    Parameters
    ----------
    metadata : mapping
        JSON values without the digest.

    Raises
    ------
    CubeFileError
        The first value that does not fit (``invalid-metadata``), by its key path.
    """
    EMISSION(metadata, "")
    _require_unique(metadata["entries"])


def _require_unique(names: list[str]) -> None:
    if len(set(names)) < len(names):
        raise CubeFileError("the names of entries must be unique", code="invalid-metadata")


def _text(value: Any, path: str) -> None:
    if not isinstance(value, str) or len(value) > MAX_TEXT:
        raise _error(path, f"must be text of at most {MAX_TEXT} characters", value)


def _number(low: float = -MAX_NUMBER, high: float = MAX_NUMBER) -> Check:
    def check(value: Any, path: str) -> None:
        valid = isinstance(value, int | float) and not isinstance(value, bool)
        if not (valid and low <= value <= high):
            raise _error(path, f"must be a number in [{low:g}, {high:g}]", value)

    return check


def _count(value: Any, path: str) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= MAX_NUMBER:
        raise _error(path, "must be a whole number from 0", value)


def _scalar(value: Any, path: str) -> None:
    if isinstance(value, str):
        _text(value, path)
    elif not isinstance(value, bool):
        _number()(value, path)


def _list(item: Check, limit: int) -> Check:
    def check(value: Any, path: str) -> None:
        if not isinstance(value, list) or len(value) > limit:
            raise _error(path, f"must be a list of at most {limit:,} items", value)
        for number, each in enumerate(value):
            item(each, f"{path}[{number}]")

    return check


def _table(
    required: Mapping[str, Check], optional: Mapping[str, Check] | None = None, *, others: bool = False
) -> Check:
    """Make a check of a table by its keys; unknown keys are errors unless ``others``."""
    known = {**required, **(optional or {})}

    def check(value: Any, path: str) -> None:
        if not isinstance(value, dict):
            raise _error(path, "must be a table", value)
        for key in required:
            if key not in value:
                raise CubeFileError(f"'{_join(path, key)}' is missing", code="invalid-metadata")
        for key, each in value.items():
            if key in known:
                known[key](each, _join(path, key))
            elif not others:
                raise CubeFileError(f"unknown key '{_join(path, key)}'", code="invalid-metadata")

    return check


def _options(value: Any, path: str) -> None:
    """Check the form of options; their ranges are checked where a build is repeated."""
    if not isinstance(value, dict) or len(value) > MAX_OPTIONS:
        raise _error(path, f"must be a table of at most {MAX_OPTIONS} options", value)
    for key, each in value.items():
        _text(key, path)
        limit = MAX_LIGHTS if key == "lights" else MAX_FILES
        item = _list(_text, limit) if isinstance(each, list) else _scalar
        item(each, _join(path, key))


def _join(path: str, key: str) -> str:
    key = shorten(key if key.isprintable() else ascii(key))
    return f"{path}.{key}" if path else key


def _error(path: str, constraint: str, value: object) -> CubeFileError:
    return CubeFileError(f"{path} {constraint}, got {format_value(value)}", code="invalid-metadata")


FILE = {"name": _text, "digest": _text}
RGB = _list(_number(), 3)
LOOK = _table(
    {
        "name": _text,
        "rgb": RGB,
        "weight": _number(0, 1),
        "lights": _list(
            _table({"light": _text, "wish": RGB, "answer": RGB, "delta_e": _number(0), "possible": _number(0)}),
            MAX_LIGHTS,
        ),
    }
)
PROVENANCE = _table(
    {},
    {
        "uplift": _text,
        "options": _options,
        "atlases": _list(_table(FILE, {"measured": _text}), MAX_FILES),
        "libraries": _list(_table(FILE), MAX_FILES),
        "families": _list(_table({"name": _text, "relevance": _number()}), MAX_FILES),
        "looks": _list(LOOK, MAX_FILES),
        "left_out": _list(_text, MAX_ENTRIES),
        "skipped": _list(_text, MAX_ENTRIES),
        "prior": _table({}, {"length": _number(0), "nugget": _number(0), "error_bound": _number(0)}, others=True),
        "improvements": _list(_table({"step": _text, "tried": _count, "mended": _count}), MAX_FILES),
        "scene": _list(_table({}, others=True), MAX_FILES),
        "filled": _table({"points": _count, "cube": _text}),
    },
    others=True,
)
MODEL = _table(
    {"name": _text},
    {
        "count": _count,
        "phase": _table({"start": _number(), "end": _number(), "warp": _text}),
        "start": _number(),
        "end": _number(),
    },
)
METADATA = _table(
    {
        "format": _text,
        "version": _count,
        "features": _list(_text, MAX_OPTIONS),
        "model": MODEL,
        "entry_model": MODEL,
        "dim": _count,
        "space": _text,
        "illuminant": _text,
        "observer": _text,
        "threshold": _number(MIN_THRESHOLD, MAX_THRESHOLD),
        "reference": _text,
        "entries": _list(_text, MAX_ENTRIES),
        "provenance": PROVENANCE,
    }
)
EMISSION = _table(
    {
        "format": _text,
        "version": _count,
        "space": _text,
        "observer": _text,
        "entries": _list(_text, MAX_ENTRIES),
        "provenance": PROVENANCE,
    }
)
