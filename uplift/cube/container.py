"""The container of cubes and emission tables: safetensors with one JSON text of
metadata (docs/cube-file.md).

Equal contents have equal bytes.
"""

import contextlib
import hashlib
import json
import os
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import CubeFileError, OutputError, UpliftError
from uplift.common.files import atomic_write, check_regular, recognise
from uplift.common.text import format_value, parse_json, printable

RANGE = 300.0, 1000.0
"""Limits of wavelengths in nm: illuminants and observers have no shorter ones, atlases
hardly longer ones.
"""
VISIBLE = 380.0, 780.0
"""Wavelengths in nm between which every file has values."""
MAX_UNEVENNESS = 1e-6
"""Difference in nm between steps of wavelengths that is rounding."""
KEY = "uplift"
"""The only metadata entry: safetensors does not keep the order of several."""
STORED_TYPES = ("F64", "F32", "U8", "I32", "I16", "U32")
"""Types of arrays, by their names in safetensors."""
MAX_VALUE = 1e30
"""Limit of all numbers: far above those of any cube, and their squares do not overflow.
"""
MAX_TEXT = 1000
"""Characters of a text."""

FORGED = (
    AttributeError, KeyError, MemoryError, OverflowError, TypeError, ValueError,
    UpliftError,
)  # fmt: skip
"""Errors of content that no version has written."""

Tensors = dict[str, NDArray[Any]]
Content = TypeVar("Content")


class Kind(NamedTuple):
    """A kind of file: the text that names it in the metadata, versions that are read,
    the noun of messages.

    ``foreign`` is the code of the error for files of another kind, ``features`` are the
    optional parts that are read.
    """

    format: str
    readable: tuple[int, ...]
    noun: str
    foreign: str
    features: tuple[str, ...] = ()


class Stored(NamedTuple):
    """How an array is stored: its shape in the letters of docs/cube-file.md, its types,
    its least and largest value.

    With a ``feature``, the array is in the files only that announce the feature.
    """

    shape: str
    types: tuple[str, ...] = ("float64",)
    low: float = -MAX_VALUE
    high: float = MAX_VALUE
    feature: str = ""


def save(
    content: tuple[Tensors, Mapping[str, Any]],
    path: str | os.PathLike[str],
    kind: Kind,
    read: Callable[[Path], object],
    *,
    force: bool,
) -> None:
    """Write arrays and metadata with their digest, atomically. The new file is read
    back before it replaces another.
    """
    from safetensors.numpy import save as encode

    tensors, metadata = content
    with atomic_write(path, force=force) as temporary:
        try:
            complete = {**metadata, "digest": content_digest(tensors, metadata)}
            # safetensors' own save_file uses another temporary file, which would remain
            # if this process were killed.
            temporary.write_bytes(encode(tensors, metadata={KEY: _json(complete)}))
            read(temporary)
        except CubeFileError as error:
            raise OutputError(
                f"the {kind.noun} would not be readable: {error.problem}",
                path=path,
                hint="an existing file is unchanged",
            ) from error


def load(
    path: Path, kind: Kind, decode: Callable[[Tensors, dict[str, Any]], Content]
) -> Content:
    """Read a file: check its kind, version, features and digest, then ``decode`` its
    arrays and metadata.

    Every error that the content causes is a `CubeFileError` about the file.
    """
    from safetensors import SafetensorError

    check_regular(
        path, CubeFileError, hint=f"check the name, or build the {kind.noun} first"
    )
    damaged = partial(CubeFileError, path=path, hint=f"build the {kind.noun} again")
    foreign = partial(damaged, code=kind.foreign)
    try:
        tensors, metadata = _read_tensors(path)
    except (SafetensorError, ValueError, TypeError, OSError, MemoryError) as error:
        got = _recognise_file(path)
        if not got or got.endswith(kind.noun):
            got = "a damaged or another file"
        raise foreign(f"must be an {kind.format}, got {got}") from error
    stated = metadata.get("format") if isinstance(metadata, dict) else None
    if stated != kind.format:
        got = "" if stated is None else f", got {format_value(stated)}"
        raise foreign(f"must be an {kind.format}{got}")
    _check_readable(metadata, kind, path)
    if metadata.pop("digest", None) != content_digest(tensors, metadata):
        raise damaged("is damaged: the content does not match its digest")
    # What follows is for files whose digest was forged.
    try:
        return decode(tensors, metadata)
    except FORGED as error:
        reason = f"{type(error).__name__}: {str(error)[:200]}"
        if isinstance(error, CubeFileError):
            reason = error.problem
        raise damaged(f"is not a valid {kind.noun}: {reason}") from error


def _read_tensors(path: Path) -> tuple[Tensors, Any]:
    """Read the arrays, in the order of their names, and the metadata."""
    from safetensors import safe_open

    with safe_open(path, framework="numpy") as file:
        metadata = parse_json((file.metadata() or {}).get(KEY, "{}"))
        names = sorted(file.keys())
        types = {file.get_slice(name).get_dtype() for name in names}
        if not types <= set(STORED_TYPES):
            raise ValueError("an array of an unknown type")
        return {name: file.get_tensor(name) for name in names}, metadata


def _recognise_file(path: Path) -> str:
    """Name what a file is by its first bytes, see `recognise`; empty if they cannot be
    read.
    """
    with contextlib.suppress(OSError), path.open("rb") as file:
        return recognise(file.read(MAX_TEXT))
    return ""


def _check_readable(metadata: dict[str, Any], kind: Kind, path: Path) -> None:
    """Raise `CubeFileError` for a version or a feature of later, or much earlier,
    versions of uplift.
    """
    provenance = metadata.get("provenance")
    writer = provenance.get("uplift") if isinstance(provenance, dict) else None
    writer = (
        f"version {printable(writer)[:40]}"
        if isinstance(writer, str)
        else "the version"
    )
    hint = f"build the {kind.noun} again, or use {writer} of uplift that wrote it"
    unreadable = partial(CubeFileError, path=path, hint=hint)
    if metadata.get("version") not in kind.readable:
        versions = " or ".join(map(str, kind.readable))
        got = format_value(metadata.get("version"))
        problem = f"must have format version {versions}, got {got}"
        raise unreadable(problem, code="cube-version")
    features = metadata.get("features")
    for feature in features if isinstance(features, list) else ():
        if isinstance(feature, str) and feature not in kind.features:
            known = ", ".join(kind.features) or "none"
            problem = f"features must be of {known}, got {format_value(feature)}"
            raise unreadable(problem, code="cube-feature")


def content_digest(tensors: Tensors, metadata: Mapping[str, Any]) -> str:
    """Compute the SHA-256 of arrays and metadata, in hexadecimal."""
    content = hashlib.sha256(_json(metadata).encode())
    for name in sorted(tensors):
        # The same bytes under another name, type or shape are another content.
        array = np.ascontiguousarray(tensors[name])
        content.update(f"{name} {array.dtype.str} {array.shape}".encode())
        content.update(array.data)
    return content.hexdigest()


def _json(metadata: Mapping[str, Any]) -> str:
    try:
        return json.dumps(
            metadata,
            sort_keys=True,
            ensure_ascii=False,
            separators=(",", ":"),
            allow_nan=False,
        )
    except (TypeError, ValueError, RecursionError) as error:
        raise CubeFileError(f"the metadata are not JSON values ({error})") from error


def require(condition: bool, problem: str) -> None:
    """Raise `CubeFileError` unless the condition is met."""
    if not condition:
        raise CubeFileError(problem)


def check_wavelengths(nm: NDArray[Any]) -> None:
    """Raise `CubeFileError` unless wavelengths (N,) in nm can be those of a sensor."""
    first, last = VISIBLE
    even = float(np.ptp(np.diff(nm))) < MAX_UNEVENNESS
    problem = f"the wavelengths must ascend evenly and hold {first:g} to {last:g} nm"
    require(even and nm[0] <= first < last <= nm[-1], problem)


def check_arrays(
    tensors: Tensors, schema: Mapping[str, Stored], sizes: Mapping[str, Any]
) -> None:
    """Check presence, type, shape and range of all arrays as stored, before anything is
    computed from them.

    ``sizes`` has the lengths that the letters of shapes stand for; other letters are
    numbers.
    """
    for name, (axes, types, low, high, _) in schema.items():
        require(name in tensors, f"has no array {name}")
        array = tensors[name]
        shape = tuple(int(sizes.get(axis, axis)) for axis in axes.split())
        fits = array.shape == shape and array.dtype.name in types
        require(fits, f"{name} must be {' or '.join(types)} of shape {shape}")
        # NaN fails both comparisons.
        in_range = bool(((array >= low) & (array <= high)).all())
        require(in_range, f"{name} must have numbers in [{low:g}, {high:g}]")


def check_metadata(value: Any, schema: Any, path: str = "metadata") -> None:
    """Raise `CubeFileError` for the first JSON value that does not fit a schema, with
    its key path.

    A schema is `str` for text, `int` for a whole number from 0, a range (low, high) of
    numbers, a list [schema, limit] of at most so many items, or a table of schemas by
    key, with ``?`` after optional keys and ``*`` for all others. None is for any value.
    Every query reads metadata, and pydantic takes long to import.
    """
    kind = type(value)
    items: dict[str, tuple[Any, Any]] = {}
    if schema is None:
        return
    if schema is str:
        fits = kind is str and len(value) <= MAX_TEXT
        expected = f"text of at most {MAX_TEXT} characters"
    elif schema is int:
        fits = kind is int and 0 <= value <= MAX_VALUE
        expected = "a whole number from 0"
    elif isinstance(schema, tuple):
        low, high = schema
        fits = kind in (int, float) and low <= value <= high
        expected = f"a number in [{low:g}, {high:g}]"
    elif isinstance(schema, list):
        item, limit = schema
        fits = kind is list and len(value) <= limit
        expected = f"a list of at most {limit:,} items"
        if fits:
            items = {f"[{number}]": (each, item) for number, each in enumerate(value)}
    else:
        known = {key.removesuffix("?"): item for key, item in schema.items()}
        required = known.keys() & schema.keys() - {"*"}
        fits = kind is dict and required <= value.keys()
        fits = fits and ("*" in schema or value.keys() <= known.keys())
        expected = f"a table of {', '.join(schema)}"
        if fits:
            items = {
                f".{key}": (value[key], known[key]) for key in value.keys() & known
            }
    if not fits:
        raise CubeFileError(f"{path} must be {expected}, got {format_value(value)}")
    for place, (each, item) in items.items():
        check_metadata(each, item, path + place)
