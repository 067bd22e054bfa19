"""The cache folder of compiled code: private to the user, and without damaged entries.

JAX runs the code that it finds there. A killed process may leave an entry incomplete, and JAX does not replace it.
"""

from __future__ import annotations

import os
import stat
import zlib
from collections.abc import Iterator
from pathlib import Path

SUFFIX = "-cache"
"""Suffix of JAX's entries."""
MARK = ".verified"
"""File whose time is that of the last verification."""
ZLIB = b"\x78"
"""First byte of entries in zlib format; JAX uses Zstandard where it is installed."""


class SharedFolderError(Exception):
    """Other users can write to the folder."""


def prepare(folder: Path) -> bool:
    """Create the folder if necessary, and remove damaged entries.

    Returns False if the user has none. Raises `SharedFolderError` if others can write to it.
    """
    if not folder.is_absolute():  # without a home folder
        return False
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        folder = folder.resolve()
        if not _is_private(folder):
            raise SharedFolderError(str(folder))
        _remove_damaged(folder)
    except OSError:
        return False
    return True


def _is_private(folder: Path) -> bool:
    if not hasattr(os, "getuid"):  # on Windows the folder is in the user's profile
        return True
    if not _is_own(folder.stat(), 0o022):
        return False
    return all(_is_safe(parent.stat()) for parent in folder.parents)


def _is_own(status: os.stat_result, writers: int) -> bool:
    return status.st_uid == os.getuid() and not status.st_mode & writers


def _is_safe(status: os.stat_result) -> bool:
    """Whether other users cannot rename what is in a folder."""
    return status.st_uid in (0, os.getuid()) and (
        not status.st_mode & stat.S_IWOTH or bool(status.st_mode & stat.S_ISVTX)
    )


def _remove_damaged(folder: Path) -> None:
    """Remove entries that are incomplete or that others can write to; each is verified once."""
    mark = folder / MARK
    verified = mark.stat().st_mtime_ns if mark.exists() else 0
    for entry in _entries(folder):
        status = entry.stat(follow_symlinks=False)
        private = stat.S_ISREG(status.st_mode) and (os.name == "nt" or _is_own(status, 0o022))
        if not private or (status.st_mtime_ns >= verified and not _is_complete(entry)):
            os.unlink(entry.path)
    mark.touch(mode=0o600)


def _entries(folder: Path) -> Iterator[os.DirEntry[str]]:
    with os.scandir(folder) as entries:
        yield from (entry for entry in entries if entry.name.endswith(SUFFIX))


def _is_complete(entry: os.DirEntry[str]) -> bool:
    """Whether an entry in zlib format has its check sum. Others are left to JAX."""
    content = Path(entry.path).read_bytes()
    if content[:1] != ZLIB:
        return bool(content)
    try:
        zlib.decompress(content)
    except zlib.error:
        return False
    return True
