"""The container of cubes and emission tables: safetensors with one JSON text of metadata (docs/cube-file.md).

Equal contents have equal bytes.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import CubeFileError, OutputError, UpliftError
from uplift.common.files import atomic_write, check_regular
from uplift.common.json_text import parse_json
from uplift.common.text import format_value, printable

KEY = "uplift"
"""The only metadata entry: safetensors does not keep the order of several."""
STORED_TYPES = ("F64", "F32", "U8", "I32", "I16", "U32")
"""Types of arrays, by their names in safetensors."""
MAX_VALUE = 1e30
"""Limit of all numbers: far above those of any cube, and their squares do not overflow."""

Tensors = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Kind:
    """A kind of file: the text that names it in the metadata, versions that are read, the noun of messages.

    ``foreign`` is the code of the error for files of another kind.
    """

    format: str
    readable: tuple[int, ...]
    noun: str
    foreign: str


@dataclass(frozen=True)
class Stored:
    """How an array is stored: its shape in the letters of docs/cube-file.md, its types, its least value.

    With a ``feature``, the array is in the files only that announce the feature.
    """

    shape: str
    types: tuple[str, ...] = ("float64",)
    low: float = -MAX_VALUE
    feature: str = ""


def save(tensors: Tensors, metadata: Mapping[str, Any], path: Path) -> None:
    """Write arrays and metadata with their digest."""
    from safetensors.numpy import save as encode

    complete = {**metadata, "digest": content_digest(tensors, metadata)}
    # safetensors' own save_file uses another temporary file, which would remain if this process were killed.
    path.write_bytes(encode(tensors, metadata={KEY: _json(complete)}))


def replace_file(
    content: tuple[Tensors, Mapping[str, Any]],
    path: str | os.PathLike[str],
    kind: Kind,
    read: Callable[[Path], object],
    *,
    force: bool,
) -> None:
    """Write arrays and metadata atomically. The new file is read back before it replaces an existing one."""
    with atomic_write(path, force=force) as temporary:
        try:
            save(*content, temporary)
            read(temporary)
        except CubeFileError as error:
            raise OutputError(
                f"the {kind.noun} would not be readable: {error.problem}",
                code="cube-unreadable",
                path=path,
                hint="an existing file is unchanged",
            ) from error


def load(path: Path, kind: Kind) -> tuple[Tensors, dict[str, Any]]:
    """Read arrays, and metadata without the digest, of a kind; check format, version and digest."""
    tensors, metadata = _load(path, kind)
    if metadata.get("version") not in kind.readable:
        versions, version = " or ".join(map(str, kind.readable)), format_value(metadata.get("version"))
        raise CubeFileError(
            f"must have format version {versions}, got {version}",
            code="cube-version",
            path=path,
            hint=f"build the {kind.noun} again, or use the version of uplift that wrote it",
        )
    if metadata.pop("digest", None) != content_digest(tensors, metadata):
        raise _invalid(path, kind, "is damaged: the content does not match its digest", "cube-damaged")
    return tensors, metadata


def _load(path: Path, kind: Kind) -> tuple[Tensors, dict[str, Any]]:
    from safetensors import SafetensorError, safe_open

    try:
        check_regular(path, CubeFileError, hint=f"name a {kind.noun} file")
    except CubeFileError as error:
        if error.code != "file-not-found":
            raise
        hint = f"build the {kind.noun} first"
        raise CubeFileError("no such file", code="cube-not-found", path=path, hint=hint) from error
    try:
        with safe_open(path, framework="numpy") as file:
            metadata = parse_json((file.metadata() or {}).get(KEY, "{}"))
            found = metadata.get("format") if isinstance(metadata, dict) else None
            if found != kind.format:
                got = "" if found is None else f", got {format_value(found)}"
                raise _invalid(path, kind, f"must be an {kind.format}{got}", kind.foreign)
            for name in file.keys():  # noqa: SIM118  not a dictionary
                if file.get_slice(name).get_dtype() not in STORED_TYPES:
                    raise _invalid(path, kind, f"has an array of an unknown type, {format_value(name)}")
            return {name: file.get_tensor(name) for name in sorted(file.keys())}, metadata
    except CubeFileError:
        raise
    except (SafetensorError, ValueError, TypeError, OSError, MemoryError) as error:
        problem = f"is not a {kind.noun} file, or is truncated ({_reason(error)})"
        raise _invalid(path, kind, problem, kind.foreign) from error


def content_digest(tensors: Tensors, metadata: Mapping[str, Any]) -> str:
    """Compute the SHA-256 of arrays and metadata, in hexadecimal."""
    content = hashlib.sha256(_json(metadata).encode())
    for name in sorted(tensors):
        array = np.ascontiguousarray(tensors[name])
        content.update(f"{name} {array.dtype.str} {array.shape}".encode())
        content.update(array.data)
    return content.hexdigest()


def _json(metadata: Mapping[str, Any]) -> str:
    try:
        return json.dumps(metadata, sort_keys=True, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise CubeFileError(f"the metadata are not JSON values ({error})", code="cube-invalid") from error


@contextlib.contextmanager
def validation(path: Path, kind: Kind) -> Iterator[None]:
    """Turn every error that the content of a file causes in the block into one `CubeFileError` about the file."""
    try:
        yield
    except CubeFileError as error:
        raise _invalid(path, kind, f"is not a valid {kind.noun}: {error.problem}") from error
    except (AttributeError, KeyError, MemoryError, OverflowError, TypeError, ValueError, UpliftError) as error:
        raise _invalid(path, kind, f"is not a valid {kind.noun} ({type(error).__name__}: {_reason(error)})") from error


def check_arrays(tensors: Tensors, schema: Mapping[str, Stored], sizes: Mapping[str, int]) -> None:
    """Check presence, type, shape and range of all arrays as stored, before anything is computed from them.

    ``sizes`` has the lengths that the letters of shapes stand for; other letters are numbers.
    """
    missing = [name for name in schema if name not in tensors]
    require(not missing, f"has no array {', '.join(missing)}")
    for name, stored in schema.items():
        array = tensors[name]
        shape = tuple(sizes[axis] if axis in sizes else int(axis) for axis in stored.shape.split())
        fits = array.shape == shape and array.dtype.name in stored.types
        require(fits, f"{name} must be {' or '.join(stored.types)} of shape {shape}")
        require(in_range(array, stored.low, MAX_VALUE), f"{name} must have numbers in [{stored.low:g}, {MAX_VALUE:g}]")


def require(condition: bool, problem: str) -> None:
    """Raise `CubeFileError` unless the condition is met."""
    if not condition:
        raise CubeFileError(problem, code="cube-invalid")


def in_range(array: NDArray[Any], low: float, high: float) -> bool:
    """Whether all numbers are in [low, high]; False for NaN."""
    return bool(((array >= low) & (array <= high)).all())


def _invalid(path: Path, kind: Kind, problem: str, code: str = "cube-invalid") -> CubeFileError:
    return CubeFileError(problem, code=code, path=path, hint=f"build the {kind.noun} again")


def _reason(error: Exception) -> str:
    """Text of an error of another library, which may quote the file."""
    return printable(str(error)[:200])
