"""The container of cubes and emission tables: safetensors with one JSON text of metadata (docs/cube-file.md).

Equal contents have equal bytes.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import CubeFileError, OutputError, UpliftError
from uplift.common.files import atomic_write
from uplift.common.json_text import parse_json
from uplift.common.text import format_value

KEY = "uplift"
"""The only metadata entry: safetensors does not keep the order of several."""
INVALID = (AttributeError, KeyError, MemoryError, OverflowError, TypeError, ValueError, UpliftError)
"""Errors caused by the content of a file."""
MAX_REASON = 200
"""Characters of an error of another library."""

STORED_TYPES = {
    "F64": "float64",
    "F32": "float32",
    "U8": "uint8",
    "I32": "int32",
    "I16": "int16",
    "U32": "uint32",
}
"""Names of the types in numpy, by their names in the file."""

Tensors = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Parameters
    ----------
    format : str
        Text by which the metadata name it.
    readable : tuple of int
        Versions that are read.
    noun : str
        Noun of messages, after "a" or "the".
    foreign : str
        Code of the error for files that are not of this kind.
    """

    format: str
    readable: tuple[int, ...]
    noun: str
    foreign: str


def save(tensors: Tensors, metadata: Mapping[str, Any], path: Path) -> None:
    """Write arrays and metadata with their digest.

    Parameters
    ----------
    tensors : dict of str to ndarray
        Arrays by their names.
    metadata : mapping
        JSON values.
    path : Path
        File to write.

    Raises
    ------
    CubeFileError
        Metadata that are not JSON values (``invalid-metadata``).
    """
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
    """Write a file atomically. The new file is read back before it replaces an existing one.

    Parameters
    ----------
    content : tuple
        Arrays and metadata.
    path : path-like
        File to write.
    kind : Kind
        Kind of the file.
    read : callable
        Reads the file and checks it.
    force : bool
        Replace an existing file.

    Raises
    ------
    OutputError
        The file exists and ``force`` is false, cannot be written, or does not read back (``cube-unreadable``).
    """
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
    """Read arrays and metadata of a kind, and check version and digest.

    Parameters
    ----------
    path : Path
        The file.
    kind : Kind
        Kind that the file must have.

    Returns
    -------
    tensors : dict of str to ndarray
        Arrays by their names.
    metadata : dict
        JSON values without the digest.

    Raises
    ------
    CubeFileError
        The file is missing, damaged, or of another kind or version.
    """
    tensors, metadata = _load(path, kind)
    if metadata.get("version") not in kind.readable:
        versions, version = " or ".join(map(str, kind.readable)), format_value(metadata.get("version"))
        raise CubeFileError(
            f"must have format version {versions}, got {version}",
            code="cube-version",
            path=path,
            hint=f"build the {kind.noun} again, or use the version of uplift that wrote it",
        )
    digest = metadata.pop("digest", None)
    if digest != content_digest(tensors, metadata):
        raise invalid_file(path, kind, "is damaged: the content does not match its digest", "cube-damaged")
    return tensors, metadata


def format_of(path: Path) -> str | None:
    """Read of which format a file is.

    Parameters
    ----------
    path : Path
        A file.

    Returns
    -------
    str or None
        The word that files of a `Kind` begin with; None for other files and for those that cannot be read.
    """
    from safetensors import SafetensorError, safe_open

    try:
        with safe_open(path, framework="numpy") as file:
            metadata = parse_json((file.metadata() or {}).get(KEY, "{}"))
    except (SafetensorError, ValueError, TypeError, OSError, MemoryError):
        return None
    found = metadata.get("format") if isinstance(metadata, dict) else None
    return found if isinstance(found, str) else None


def content_digest(tensors: Tensors, metadata: Mapping[str, Any]) -> str:
    """Compute the digest of arrays and metadata.

    Parameters
    ----------
    tensors : dict of str to ndarray
        Arrays by their names.
    metadata : mapping
        JSON values.

    Returns
    -------
    str
        SHA-256 in hexadecimal.

    Raises
    ------
    CubeFileError
        Metadata that are not JSON values (``invalid-metadata``).
    """
    return _digest(tensors, _json(metadata))


def _digest(tensors: Tensors, metadata: str) -> str:
    content = hashlib.sha256(metadata.encode())
    for name in sorted(tensors):
        array = np.ascontiguousarray(tensors[name])
        content.update(f"{name} {array.dtype.str} {array.shape}".encode())
        content.update(array.data)
    return content.hexdigest()


def error_text(error: Exception) -> str:
    """Return the text of an error of another library, which may quote the file.

    Parameters
    ----------
    error : Exception
        The error.

    Returns
    -------
    str
        Printable text.
    """
    text = str(error)[:MAX_REASON]
    return text if text.isprintable() else ascii(text)


def invalid_file(path: Path, kind: Kind, problem: str, code: str) -> CubeFileError:
    """Make the error for an invalid file.

    Parameters
    ----------
    path : Path
        The file.
    kind : Kind
        Kind that it must have.
    problem : str
        The constraint and the value received.
    code : str
        Stable identifier.

    Returns
    -------
    CubeFileError
        The error to raise.
    """
    return CubeFileError(problem, code=code, path=path, hint=f"build the {kind.noun} again")


def _load(path: Path, kind: Kind) -> tuple[Tensors, dict[str, Any]]:
    from safetensors import SafetensorError, safe_open

    if not os.path.isfile(path):  # Path.is_file raises for impossible names
        raise _not_a_file(path, kind)
    try:
        with safe_open(path, framework="numpy") as file:
            metadata = parse_json((file.metadata() or {}).get(KEY, "{}"))
            if not isinstance(metadata, dict) or metadata.get("format") != kind.format:
                raise invalid_file(path, kind, _foreign_problem(metadata, kind), kind.foreign)
            for name in file.keys():  # noqa: SIM118  not a dictionary
                if file.get_slice(name).get_dtype() not in STORED_TYPES:
                    problem = f"has an array of an unknown type, {ascii(name)[:40]}"
                    raise invalid_file(path, kind, problem, "invalid-array")
            tensors = {name: file.get_tensor(name) for name in sorted(file.keys())}
    except CubeFileError:
        raise
    except (SafetensorError, ValueError, TypeError, OSError, MemoryError) as error:
        problem = f"is not a {kind.noun} file, or is truncated ({error_text(error)})"
        raise invalid_file(path, kind, problem, kind.foreign) from error
    return tensors, metadata


def _foreign_problem(metadata: Any, kind: Kind) -> str:
    """Describe a file of another kind, which is named if the file names it."""
    found = metadata.get("format") if isinstance(metadata, dict) else None
    return f"must be an {kind.format}" + ("" if found is None else f", got {format_value(found)}")


def _not_a_file(path: Path, kind: Kind) -> CubeFileError:
    if os.path.exists(path):
        return CubeFileError(
            "must be a file, got a folder, a device or a pipe",
            code="not-a-regular-file",
            path=path,
            hint=f"name a {kind.noun} file",
        )
    try:
        os.stat(path)
    except PermissionError as error:
        problem = f"cannot be read: {error.strerror}"
        return CubeFileError(problem, code="file-unreadable", path=path, hint="check its permissions")
    except (OSError, ValueError):
        pass
    return CubeFileError("no such file", code="cube-not-found", path=path, hint=f"build the {kind.noun} first")


def _json(metadata: Mapping[str, Any]) -> str:
    try:
        return json.dumps(metadata, sort_keys=True, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise CubeFileError(f"the metadata are not JSON values ({error})", code="invalid-metadata") from error
