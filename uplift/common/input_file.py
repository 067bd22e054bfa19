"""Reading of small files: regular files of limited size, never devices or pipes."""

from __future__ import annotations

import os
import stat

from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftError

__all__ = ["check_regular", "read_bytes"]

FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
"""Opening a pipe, or reading a file of the kernel, must not wait."""


def check_regular(path: StrPath, error: type[UpliftError], *, hint: str) -> None:
    """Check that a path is a regular file, which ends and can be read twice.

    Parameters
    ----------
    path : path-like
        The file.
    error : type of UpliftError
        The type of the errors raised.
    hint : str
        How to solve the problem.

    Raises
    ------
    UpliftError
        The file is missing (``file-not-found``), it is a folder, a device or a pipe (``not-a-regular-file``), or it
        cannot be examined (``file-unreadable``).
    """
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError) as cause:
        raise _unreadable(path, error, hint, cause) from cause
    _check_mode(mode, path, error, hint)


def read_bytes(path: StrPath, error: type[UpliftError], *, limit: int, hint: str) -> bytes:
    """Read a regular file.

    Parameters
    ----------
    path : path-like
        The file.
    error : type of UpliftError
        The type of the errors raised.
    limit : int
        Largest size in bytes.
    hint : str
        How to solve the problem.

    Returns
    -------
    bytes
        The content.

    Raises
    ------
    UpliftError
        As `check_regular`; the file exceeds the limit (``file-too-large``), or cannot be read (``file-unreadable``).
    """
    check_regular(path, error, hint=hint)
    try:
        with open(os.open(path, FLAGS), "rb") as file:
            _check_mode(os.fstat(file.fileno()).st_mode, path, error, hint)  # another file may have this name now
            data = file.read(limit + 1)
    except UpliftError:
        raise
    except (OSError, ValueError) as cause:
        raise _unreadable(path, error, hint, cause) from cause
    if data is None:
        raise _unreadable(path, error, hint, OSError("it has no content yet"))
    if len(data) > limit:
        raise error(f"must not exceed {limit:,} bytes", code="file-too-large", path=path, hint=hint)
    return data


def _check_mode(mode: int, path: StrPath, error: type[UpliftError], hint: str) -> None:
    if not stat.S_ISREG(mode):
        kind = "a folder" if stat.S_ISDIR(mode) else "a device or a pipe"
        raise error(f"must be a file, got {kind}", code="not-a-regular-file", path=path, hint=hint)


def _unreadable(path: StrPath, error: type[UpliftError], hint: str, cause: Exception) -> UpliftError:
    if isinstance(cause, FileNotFoundError | NotADirectoryError):
        return error("no such file", code="file-not-found", path=path, hint=hint)
    reason = getattr(cause, "strerror", None) or cause  # a null byte in the path has none
    return error(f"cannot be read: {reason}", code="file-unreadable", path=path, hint=hint)
