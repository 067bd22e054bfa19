"""Files in and out: regular files of limited size are read; a file that is written is complete or absent.

A writer fills a temporary file in the same folder, flushes it to disk and renames it. With concurrent writers the last
one to finish wins.
"""

from __future__ import annotations

import contextlib
import os
import stat
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from uplift.common.errors import OutputError, UpliftError

if TYPE_CHECKING:
    from uplift.common.arrays import StrPath  # which imports numpy

__all__ = [
    "atomic_write",
    "check_folder",
    "check_output",
    "check_outputs",
    "check_regular",
    "read_bytes",
    "remove_stale",
    "remove_temporaries",
    "write_text",
]

DAY = 86_400.0
"""Seconds without a change after which a temporary file belongs to a writer that was killed."""
READ = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
"""Opening a pipe, or reading a file of the kernel, must not wait."""
_TEMPORARIES: set[Path] = set()
"""Temporary files that this process is writing."""


def check_regular(path: StrPath, error: type[UpliftError], *, hint: str) -> None:
    """Check that a path is a regular file, which ends and can be read twice; raise ``error`` otherwise."""
    try:
        mode = os.stat(path).st_mode
    except (FileNotFoundError, NotADirectoryError) as cause:
        raise error("no such file", code="file-not-found", path=path, hint=hint) from cause
    except (OSError, ValueError) as cause:
        raise _unreadable(path, error, hint, cause) from cause
    if not stat.S_ISREG(mode):
        kind = "a folder" if stat.S_ISDIR(mode) else "a device or a pipe"
        raise error(f"must be a file, got {kind}", code="not-a-regular-file", path=path, hint=hint)


def read_bytes(path: StrPath, error: type[UpliftError], *, limit: int, hint: str) -> bytes:
    """Read a regular file of at most ``limit`` bytes; raise ``error`` otherwise."""
    check_regular(path, error, hint=hint)
    try:
        with open(os.open(path, READ), "rb") as file:
            data = file.read(limit + 1)
    except (OSError, ValueError) as cause:
        raise _unreadable(path, error, hint, cause) from cause
    if data is None:
        raise _unreadable(path, error, hint, OSError("it has no content yet"))
    if len(data) > limit:
        raise error(f"must not exceed {limit:,} bytes", code="file-unreadable", path=path, hint=hint)
    return data


def _unreadable(path: StrPath, error: type[UpliftError], hint: str, cause: Exception) -> UpliftError:
    reason = getattr(cause, "strerror", None) or cause  # a null byte in the path has none
    return error(f"cannot be read: {reason}", code="file-unreadable", path=path, hint=hint)


def check_outputs(
    paths: Iterable[StrPath | None], *, inputs: Iterable[StrPath | None] = (), force: bool = False
) -> None:
    """Check all outputs of a program before it reads and writes anything, as `check_output`; None are left out."""
    inputs = list(inputs)
    checked: dict[Path, StrPath] = {}
    for path in paths:
        if path is None:
            continue
        place = check_output(path, inputs=inputs, force=force).resolve()
        if place in checked:
            problem = f"is the same file as {os.fspath(checked[place])}"
            raise OutputError(problem, code="duplicate-output", path=path, hint="give each output its own name")
        checked[place] = path


def check_output(path: StrPath, *, inputs: Iterable[StrPath | None] = (), force: bool = False) -> Path:
    """Check that a file can be written, before long work rather than after it.

    An existing file is accepted with ``force``, one of the ``inputs`` never (``output-is-input``). Names of inputs
    without a file, such as those of shipped atlases, are ignored.
    """
    if os.fspath(path) == "-":
        hint = "give a file name, or ./- for a file of this name"
        raise OutputError("stands for standard output, which cannot hold a file", path=path, hint=hint)
    path, status = Path(path), None
    try:
        status = path.stat()
    except FileNotFoundError:
        pass
    except (OSError, ValueError) as error:  # no permission, too long, with NUL, or a loop of links
        reason = getattr(error, "strerror", None) or error
        raise OutputError(f"cannot be written: {reason}", path=path, hint="choose another name") from error
    if status is not None:
        existing = (each for each in inputs if each is not None and os.path.exists(each))
        if any(os.path.samestat(status, os.stat(each)) for each in existing):
            problem = "is read as input and must not be replaced"
            raise OutputError(problem, code="output-is-input", path=path, hint="choose another name")
        if not stat.S_ISREG(status.st_mode):
            problem, hint = "is not a regular file", "name a file to write to"
            raise OutputError(problem, code="not-a-regular-file", path=path, hint=hint)
        if not force:
            hint = "pass force=True to replace it, or choose another name"
            raise OutputError("exists already", code="file-exists", path=path, hint=hint)
    folder = path.resolve().parent
    if not folder.is_dir():
        raise OutputError(f"the folder {folder} does not exist", path=path, hint="create it first")
    if not os.access(folder, os.W_OK):
        raise OutputError(f"no permission to write in {folder}", path=path, hint="choose another folder")
    return path


def check_folder(
    path: StrPath, names: Iterable[str], *, inputs: Iterable[StrPath | None] = (), force: bool = False
) -> Path:
    """Create a folder if necessary, and check that files with these names can be written in it."""
    folder = Path(path)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        problem = f"cannot be created: {error.strerror}"
        raise OutputError(problem, path=folder, hint="name a folder to write to") from error
    check_outputs([folder / name for name in names], inputs=inputs, force=force)
    return folder


def write_text(text: str, path: StrPath, *, force: bool = False) -> None:
    """Write text as UTF-8 with LF line ends, atomically."""
    with atomic_write(path, force=force) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextlib.contextmanager
def atomic_write(path: StrPath, *, force: bool = False) -> Iterator[Path]:
    """Provide a temporary path that is renamed to ``path`` if the block succeeds, and removed if it fails.

    A replaced file keeps its permissions. A symbolic link is kept and its target replaced.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_write(Path(folder) / "notes.txt") as temporary:
    ...         _ = temporary.write_text("complete")
    ...     print((Path(folder) / "notes.txt").read_text())
    complete
    """
    path = check_output(path, force=force)
    target = path.resolve()
    temporary = target.with_name(f"{_prefix(target)}{os.urandom(4).hex()}.part")
    _TEMPORARIES.add(temporary)
    try:
        remove_stale(target)
        temporary.touch(exist_ok=False)
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        if target.exists():
            temporary.chmod(stat.S_IMODE(target.stat().st_mode) & 0o777)
        os.replace(temporary, target)
    except OutputError:
        raise
    except OSError as error:
        problem = f"cannot be written: {error.strerror or error}"
        raise OutputError(problem, path=path, hint="an existing file is unchanged") from error
    finally:
        temporary.unlink(missing_ok=True)
        _TEMPORARIES.discard(temporary)


def remove_stale(path: StrPath, seconds: float = DAY) -> None:
    """Remove the temporary files of writers to a path that have not changed for so long: their writers were killed."""
    target = Path(path).resolve()
    for entry in os.scandir(target.parent):
        if entry.name.startswith(_prefix(target)) and entry.name.endswith(".part"):
            with contextlib.suppress(OSError):
                if time.time() - entry.stat().st_mtime >= seconds:
                    os.unlink(entry)


def remove_temporaries() -> None:
    """Remove the temporary files that this process is writing, before it ends without leaving its blocks."""
    for temporary in list(_TEMPORARIES):
        with contextlib.suppress(OSError):
            temporary.unlink()


def _prefix(target: Path) -> str:
    return f".{target.name[:40]}."
