"""Files that are whole or not there: written beside their place, then renamed into it."""

from __future__ import annotations

import contextlib
import os
import re
import stat
import tempfile
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path

from uplift.common.errors import OutputError

try:
    import fcntl
except ImportError:  # not on Windows: there, what a killed process leaves stays until somebody removes it
    fcntl = None  # type: ignore[assignment]

SUFFIX = ".part"
"""Of files that are being written."""

_UMASK = threading.Lock()


def check_output(path: str | os.PathLike[str], *, force: bool = False) -> Path:
    """The path, if it can be written. Raises `OutputError`; asks before long work, not after."""
    if os.fspath(path) == "-":
        raise OutputError(
            "stands for standard output, which takes no files",
            path=path,
            hint="name a file, or give the whole path of one that is called so",
        )
    path = Path(path)
    mode = _mode(path)
    if mode is not None and not stat.S_ISREG(mode):
        raise OutputError("is no regular file", path=path, hint="name a file to write to")
    if mode is not None and not force:
        raise OutputError("exists already", path=path, hint="use --force to replace it, or another name")
    folder = path.resolve().parent
    if not folder.is_dir():
        raise OutputError(f"there is no folder {folder}", path=path, hint="make it first")
    if not os.access(folder, os.W_OK):
        raise OutputError(f"no permission to write in {folder}", path=path, hint="choose another place")
    return path


def _mode(path: Path) -> int | None:
    """What stands at the path, None for nothing. Raises `OutputError` for names that no file can have."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:  # too long a name, a NUL in it, links in a circle
        raise OutputError(f"cannot be written: {error}", path=path, hint="choose another name") from error


def check_folder(path: str | os.PathLike[str], names: Iterable[str], *, force: bool = False) -> Path:
    """The folder, made if it is not there, with room for files of these names. Raises `OutputError`."""
    folder = Path(path)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot be made: {error.strerror}", path=folder, hint="name a folder to write to"
        ) from error
    for name in names:
        check_output(folder / name, force=force)
    return folder


def write_text(text: str, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write text as it is, atomically. Raises `OutputError`."""
    with atomic_write(path, force=force) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextlib.contextmanager
def atomic_write(path: str | os.PathLike[str], *, force: bool = False) -> Iterator[Path]:
    """A temporary path in the same folder; renamed to ``path`` if the block ends well, removed if not.

    Of several at once to one path the last to end has it, whole. A link is kept, what it leads to replaced. What
    killed processes left half-written beside ``path`` is removed; what others are writing now is locked, and stays.

    Raises `OutputError` where the path cannot be written, the disk is full, or the file exists and
    ``force`` is off.
    """
    path = check_output(path, force=force)
    target = path.resolve()
    prefix = f".{target.name[:40]}."
    try:
        _remove_stale(target.parent, prefix)
        handle, temporary = _reserve(target.parent, prefix)
    except OSError as error:
        raise _cannot_write(path, error) from error
    try:
        yield temporary
        _settle(temporary)
        os.replace(temporary, target)
    except OutputError:
        raise
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)
        if fcntl is not None:
            os.close(handle)


def _reserve(folder: Path, prefix: str) -> tuple[int, Path]:
    """A new file, locked for as long as its descriptor is open."""
    while True:
        handle, name = tempfile.mkstemp(prefix=prefix, suffix=SUFFIX, dir=folder)
        if fcntl is None:
            os.close(handle)  # Windows renames no open file
            return handle, Path(name)
        with contextlib.suppress(OSError):  # file systems without locks: nobody finds it stale there either
            fcntl.flock(handle, fcntl.LOCK_EX)
        if os.fstat(handle).st_nlink:
            return handle, Path(name)
        os.close(handle)  # somebody took it for stale before it was locked


def _remove_stale(folder: Path, prefix: str) -> None:
    """Remove the temporary files of ``prefix`` that nobody holds: their writers were killed."""
    if fcntl is None:
        return
    name = re.compile(re.escape(prefix) + "[a-z0-9_]{8}" + re.escape(SUFFIX))
    for path in [Path(entry) for entry in os.scandir(folder) if name.fullmatch(entry.name)]:
        with contextlib.suppress(OSError), path.open("rb+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()


def _settle(temporary: Path) -> None:
    """On the disk, with the permissions of any new file, before it takes the name."""
    with _UMASK:  # a process has one, and asking for it changes it
        umask = os.umask(0)
        os.umask(umask)
    temporary.chmod(0o666 & ~umask)
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())


def _cannot_write(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot be written: {error.strerror or error}", path=path, hint="the old file is intact"
    )
