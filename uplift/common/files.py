"""Atomic writing: a file is complete or absent, and never takes the place of an input.

A writer fills a temporary file in the same folder, then renames it. A lock on the temporary file distinguishes a live
writer from a killed one, whose file the next writer to the same path removes. A file that appeared during the work is
replaced only with ``force``; else the result is kept under another name.
"""

from __future__ import annotations

import contextlib
import errno
import itertools
import os
import re
import stat
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path

from uplift.common.arrays import StrPath
from uplift.common.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows: temporary files of killed processes stay
    fcntl = None  # type: ignore[assignment]

__all__ = [
    "atomic_write",
    "check_folder",
    "check_output",
    "check_outputs",
    "remove_stale",
    "remove_temporaries",
    "write_text",
]

SUFFIX = ".part"
"""Suffix of temporary files."""
NO_HARD_LINKS = {errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK, errno.EXDEV}
"""Errors of file systems without hard links."""

Identity = tuple[int, int]
"""Device and inode of a file."""

_UMASK = threading.Lock()
_TEMPORARIES: set[Path] = set()
"""Temporary files that this process is writing."""


def check_outputs(
    paths: Iterable[StrPath | None], *, inputs: Iterable[StrPath | None] = (), force: bool = False
) -> None:
    """Check all outputs of a program before it reads and writes anything.

    Parameters
    ----------
    paths : iterable of path-like or None
        The files to write, None for those that are not written.
    inputs : iterable of path-like or None
        The files to read, which no output may replace. Names without a file are ignored.
    force : bool
        Accept existing files.

    Raises
    ------
    OutputError
        As `check_output` for each file, or two outputs are the same file (code ``duplicate-output``).
    """
    identities, checked = _identities(inputs), dict[Path, StrPath]()
    for path in paths:
        if path is None:
            continue
        place = _check(path, identities, force=force).resolve()
        if place in checked:
            raise OutputError(
                f"is the same file as {os.fspath(checked[place])}",
                code="duplicate-output",
                path=path,
                hint="give each output its own name",
            )
        checked[place] = path


def check_output(path: StrPath, *, inputs: Iterable[StrPath | None] = (), force: bool = False) -> Path:
    """Check that a file can be written, before long work rather than after it.

    Parameters
    ----------
    path : path-like
        The file to write.
    inputs : iterable of path-like or None
        The files to read, which the output must not replace, even with ``force``.
    force : bool
        Accept an existing file.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    OutputError
        The path cannot be written, exists and ``force`` is false, or is one of the inputs (code
        ``output-is-input``).
    """
    return _check(path, _identities(inputs), force=force)


def _check(path: StrPath, inputs: set[Identity], *, force: bool) -> Path:
    if os.fspath(path) == "-":
        raise OutputError(
            "stands for standard output, which cannot hold a file",
            code="standard-output",
            path=path,
            hint="give a file name, or ./- for a file of this name",
        )
    path = Path(path)
    status = _status(path)
    if status is not None and (status.st_dev, status.st_ino) in inputs:
        raise OutputError(
            "is read as input and must not be replaced",
            code="output-is-input",
            path=path,
            hint="choose another name",
        )
    if status is not None and not stat.S_ISREG(status.st_mode):
        raise OutputError("is not a regular file", code="not-a-regular-file", path=path, hint="name a file to write to")
    if status is not None and not force:
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
        raise _no_permission(path, folder)
    return path


def _no_permission(path: Path, folder: Path) -> OutputError:
    return OutputError(
        f"no permission to write in {folder}",
        code="no-permission",
        path=path,
        hint="choose another folder",
    )


def check_folder(
    path: StrPath, names: Iterable[str], *, inputs: Iterable[StrPath | None] = (), force: bool = False
) -> Path:
    """Create a folder if necessary, and check that files can be written in it.

    Parameters
    ----------
    path : path-like
        The folder. Its parent must exist.
    names : iterable of str
        Names of the files.
    inputs : iterable of path-like or None
        The files to read, which no output may replace.
    force : bool
        Accept existing files.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    OutputError
        The folder cannot be created, or a file fails `check_outputs`.
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
    check_outputs([folder / name for name in names], inputs=inputs, force=force)
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

    A replaced file keeps its permissions. With ``force`` the last of several concurrent writers wins. Without it the
    first wins, and the results of the others are kept under names with a number. A symbolic link is kept and its target
    replaced. Temporary files of killed writers to the same path are removed; those of live writers are locked and stay.

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
        The path cannot be written, the disk is full, or the file exists and ``force`` is false (code
        ``file-exists``; ``file-appeared`` if it was created during the block).

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
    try:
        remove_stale(target)
        handle, temporary = _reserve(target)
    except OSError as error:
        raise _write_error(path, error) from error
    try:
        yield temporary
        _flush(temporary, target, force=force)
        _publish(temporary, target, path, force=force)
    except OutputError:
        raise
    except OSError as error:
        raise _write_error(path, error) from error
    finally:
        _discard(temporary)
        if fcntl is not None:
            os.close(handle)


def remove_stale(path: StrPath) -> None:
    """Remove the temporary files of killed writers to a path. Those of live writers are locked and stay.

    Parameters
    ----------
    path : path-like
        The file that the writers would have written.

    Raises
    ------
    OSError
        The folder cannot be listed.
    """
    if fcntl is None:
        return
    target = Path(path).resolve()
    name = re.compile(re.escape(_prefix(target)) + "[a-z0-9_]{8}" + re.escape(SUFFIX))
    for temporary in [Path(entry) for entry in os.scandir(target.parent) if name.fullmatch(entry.name)]:
        with contextlib.suppress(OSError), temporary.open("rb+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            temporary.unlink()


def remove_temporaries() -> None:
    """Remove the temporary files that this process is writing, before it ends without leaving its blocks."""
    for temporary in list(_TEMPORARIES):
        with contextlib.suppress(OSError):
            _discard(temporary)


def _status(path: Path) -> os.stat_result | None:
    """Return the status of a file, None if there is none. Raise `OutputError` for impossible names."""
    try:
        return path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except PermissionError as error:
        raise _no_permission(path, path.parent) from error
    except (OSError, ValueError) as error:  # too long, with NUL, or a loop of links
        raise OutputError(
            f"cannot be written: {getattr(error, 'strerror', None) or error}",
            code="invalid-file-name",
            path=path,
            hint="choose another name",
        ) from error


def _identities(paths: Iterable[StrPath | None]) -> set[Identity]:
    """Return device and inode of the files that exist; names such as those of shipped atlases have none."""
    found = set()
    for path in paths:
        if path is not None:
            with contextlib.suppress(OSError, ValueError):
                status = os.stat(path)
                found.add((status.st_dev, status.st_ino))
    return found


def _prefix(target: Path) -> str:
    return f".{target.name[:40]}."


def _reserve(target: Path) -> tuple[int, Path]:
    """Create a temporary file that is locked as long as its descriptor is open."""
    import tempfile  # slow to import, and readers do not need it

    while True:
        handle, name = tempfile.mkstemp(prefix=_prefix(target), suffix=SUFFIX, dir=target.parent)
        temporary = Path(name)
        _TEMPORARIES.add(temporary)
        if fcntl is None:
            os.close(handle)  # Windows cannot rename an open file
            return handle, temporary
        with contextlib.suppress(OSError):  # without locks, no other writer finds the file stale either
            fcntl.flock(handle, fcntl.LOCK_EX)
        if os.fstat(handle).st_nlink:
            return handle, temporary
        _TEMPORARIES.discard(temporary)
        os.close(handle)  # another writer removed it as stale before it was locked


def _discard(temporary: Path) -> None:
    temporary.unlink(missing_ok=True)
    _TEMPORARIES.discard(temporary)


def _flush(temporary: Path, target: Path, *, force: bool) -> None:
    """Write the file to disk, with the owner and permissions of the file that it replaces, or those of a new one."""
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())
    try:
        old = target.stat() if force else None
    except FileNotFoundError:
        old = None
    if old is None:
        temporary.chmod(0o666 & ~_umask())
        return
    if hasattr(os, "chown"):
        with contextlib.suppress(OSError):  # only root can give files away
            os.chown(temporary, old.st_uid, old.st_gid)
    temporary.chmod(stat.S_IMODE(old.st_mode) & 0o777)


def _umask() -> int:
    """Return the umask of the process. Reading it changes it for a moment."""
    with _UMASK:
        umask = os.umask(0)
        os.umask(umask)
    return umask


def _publish(temporary: Path, target: Path, path: Path, *, force: bool) -> None:
    """Give the complete file its name, or a name with a number if another program took it during the work."""
    if force:
        os.replace(temporary, target)
        return
    with contextlib.suppress(FileExistsError):
        _rename_new(temporary, target)
        return
    for number in itertools.count(2):
        kept = target.with_name(f"{target.stem[:40]}-{number}{target.suffix[:40]}")
        with contextlib.suppress(FileExistsError):
            _rename_new(temporary, kept)
            raise OutputError(
                f"was created by another program during the work; the result is in {path.parent / kept.name}",
                code="file-appeared",
                path=path,
                hint="compare the two files",
            )


def _rename_new(temporary: Path, target: Path) -> None:
    """Rename a file. Raises `FileExistsError` if the new name is taken, which `os.replace` would not."""
    if os.name == "nt":
        os.rename(temporary, target)
        return
    try:
        os.link(temporary, target)
    except OSError as error:
        if error.errno not in NO_HARD_LINKS:
            raise
        os.close(os.open(target, os.O_CREAT | os.O_EXCL))
        os.replace(temporary, target)


def _write_error(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot be written: {error.strerror or error}",
        code="cannot-write",
        path=path,
        hint="an existing file is unchanged",
    )
