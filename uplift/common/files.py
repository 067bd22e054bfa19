"""Atomic writing: a file is complete or absent.

A writer fills a temporary file in the same folder, then renames it. A lock on the temporary file distinguishes a live
writer from a killed one, whose file the next writer to the same path removes.
"""

from __future__ import annotations

import contextlib
import os
import re
import stat
import tempfile
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path

from uplift.common.arrays import StrPath
from uplift.common.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows: temporary files of killed processes stay
    fcntl = None  # type: ignore[assignment]

__all__ = ["atomic_write", "check_folder", "check_output", "write_text"]

SUFFIX = ".part"
"""Suffix of temporary files."""

_UMASK = threading.Lock()


def check_output(path: StrPath, *, force: bool = False) -> Path:
    """Check that a file can be written, before long work rather than after it.

    Parameters
    ----------
    path : path-like
        The file to write.
    force : bool
        Accept an existing file.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    OutputError
        The path cannot be written, or exists and ``force`` is false.
    """
    if os.fspath(path) == "-":
        raise OutputError(
            "stands for standard output, which cannot hold a file",
            code="standard-output",
            path=path,
            hint="give a file name, or ./- for a file of this name",
        )
    path = Path(path)
    mode = _mode(path)
    if mode is not None and not stat.S_ISREG(mode):
        raise OutputError(
            "is not a regular file", code="not-a-regular-file", path=path, hint="name a file to write to"
        )
    if mode is not None and not force:
        raise OutputError(
            "exists already",
            code="file-exists",
            path=path,
            hint="pass force=True to replace it, or choose another name",
        )
    folder = path.resolve().parent
    if not folder.is_dir():
        raise OutputError(
            f"the folder {folder} does not exist", code="folder-missing", path=path, hint="create it first"
        )
    if not os.access(folder, os.W_OK):
        raise OutputError(
            f"no permission to write in {folder}",
            code="no-permission",
            path=path,
            hint="choose another folder",
        )
    return path


def check_folder(path: StrPath, names: Iterable[str], *, force: bool = False) -> Path:
    """Create a folder if necessary, and check that files can be written in it.

    Parameters
    ----------
    path : path-like
        The folder. Its parent must exist.
    names : iterable of str
        Names of the files.
    force : bool
        Accept existing files.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    OutputError
        The folder cannot be created, or a file fails `check_output`.
    """
    folder = Path(path)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot be created: {error.strerror}",
            code="folder-not-created",
            path=folder,
            hint="name a folder to write to",
        ) from error
    for name in names:
        check_output(folder / name, force=force)
    return folder


def write_text(text: str, path: StrPath, *, force: bool = False) -> None:
    """Write text as UTF-8 with LF line ends, atomically.

    Parameters
    ----------
    text : str
        The text.
    path : path-like
        The file to write.
    force : bool
        Replace an existing file.

    Raises
    ------
    OutputError
        As `atomic_write`.
    """
    with atomic_write(path, force=force) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextlib.contextmanager
def atomic_write(path: StrPath, *, force: bool = False) -> Iterator[Path]:
    """Provide a temporary path that is renamed to ``path`` if the block succeeds, and removed if it fails.

    With concurrent writers the last one to finish wins. A symbolic link is kept and its target replaced. Temporary
    files of killed writers to the same path are removed; those of live writers are locked and stay.

    Parameters
    ----------
    path : path-like
        The file to write.
    force : bool
        Replace an existing file.

    Yields
    ------
    Path
        Temporary file in the same folder.

    Raises
    ------
    OutputError
        The path cannot be written, the disk is full, or the file exists and ``force`` is false.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_write(Path(folder) / "notes.txt") as temporary:
    ...         _ = temporary.write_text("complete")
    ...     print((Path(folder) / "notes.txt").read_text())
    complete
    """
    path = check_output(path, force=force)
    target = path.resolve()
    prefix = f".{target.name[:40]}."
    try:
        _remove_stale(target.parent, prefix)
        handle, temporary = _reserve(target.parent, prefix)
    except OSError as error:
        raise _write_error(path, error) from error
    try:
        yield temporary
        _flush(temporary)
        os.replace(temporary, target)
    except OutputError:
        raise
    except OSError as error:
        raise _write_error(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)
        if fcntl is not None:
            os.close(handle)


def _mode(path: Path) -> int | None:
    """Return the mode of a file, None if there is none. Raise `OutputError` for impossible names."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:  # too long, with NUL, or a loop of links
        raise OutputError(
            f"cannot be written: {error}", code="invalid-file-name", path=path, hint="choose another name"
        ) from error


def _reserve(folder: Path, prefix: str) -> tuple[int, Path]:
    """Create a temporary file that is locked as long as its descriptor is open."""
    while True:
        handle, name = tempfile.mkstemp(prefix=prefix, suffix=SUFFIX, dir=folder)
        if fcntl is None:
            os.close(handle)  # Windows cannot rename an open file
            return handle, Path(name)
        with contextlib.suppress(OSError):  # without locks, no other writer finds the file stale either
            fcntl.flock(handle, fcntl.LOCK_EX)
        if os.fstat(handle).st_nlink:
            return handle, Path(name)
        os.close(handle)  # another writer removed it as stale before it was locked


def _remove_stale(folder: Path, prefix: str) -> None:
    """Remove temporary files that no process has locked: their writers were killed."""
    if fcntl is None:
        return
    name = re.compile(re.escape(prefix) + "[a-z0-9_]{8}" + re.escape(SUFFIX))
    for path in [Path(entry) for entry in os.scandir(folder) if name.fullmatch(entry.name)]:
        with contextlib.suppress(OSError), path.open("rb+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()


def _flush(temporary: Path) -> None:
    """Write the file to disk with the permissions of a new file, before the rename."""
    with _UMASK:  # reading the umask of the process changes it for a moment
        umask = os.umask(0)
        os.umask(umask)
    temporary.chmod(0o666 & ~umask)
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())


def _write_error(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot be written: {error.strerror or error}",
        code="cannot-write",
        path=path,
        hint="an existing file is unchanged",
    )
