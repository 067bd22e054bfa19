"""Files in and out: regular files of limited size are read; a file that is written is
complete or absent.

A writer fills a temporary file in the same folder, flushes it to disk and renames it.
With concurrent writers the last one to finish wins.
"""

import contextlib
import functools
import os
import re
import stat
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from uplift.common.errors import OutputError, StrPath, UpliftError

DAY = 86_400.0
"""Seconds without a change after which a temporary file belongs to a writer that was
killed.
"""
KERNEL = "/proc"
"""Folder of the files of the kernel, where there is one."""
MARKS = {
    # PNG, OpenEXR, JPEG, both orders of TIFF, HDR; GIF, WebP, HEIF and AVIF
    rb"\x89PNG|v/1\x01|\xff\xd8\xff|II\*\0|MM\0\*|#\?": "an image",
    rb"GIF8|RIFF.{4}WEBP|.{4}ftyp": "an image",
    rb"PK\x03\x04.{26}[^\0]{1,99}\.npy": "a NumPy archive (.npz)",
    rb"PK\x03\x04": "a ZIP archive",
    rb"\x93NUMPY": "a NumPy array (.npy)",
    rb"MATLAB \d\.\d MAT": "a MATLAB file",
    rb"\x89HDF": "an HDF5 file",
    rb"%PDF": "a PDF document",
    rb"\x1f\x8b": "a file compressed by gzip",
}
"""Kinds of files by regular expressions of their first bytes."""
CONTAINERS = {b"uplift cube": "a cube", b"uplift emission table": "an emission table"}
"""Kinds of files by their mark in the header of safetensors."""
PREFIX = ".{}."
"""First characters of temporary files, by the name of the file."""
_TEMPORARIES: set[Path] = set()
"""Temporary files that this process is writing."""


def check_regular(path: StrPath, error: type[UpliftError], *, hint: str) -> None:
    """Check that a path is a regular file, which ends and can be read twice; raise
    ``error`` otherwise.

    Files of the kernel such as ``/proc/kmsg`` look regular, but reading them may never
    end.
    """
    with _reading(path, error, hint):
        status = os.stat(path)
    if not stat.S_ISREG(status.st_mode) or (
        os.path.exists(KERNEL) and status.st_dev == os.stat(KERNEL).st_dev
    ):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a device or a pipe"
        raise error(
            f"must be a file, got {kind}", code="file-unreadable", path=path, hint=hint
        )


def read_bytes(
    path: StrPath, error: type[UpliftError], *, limit: int, hint: str
) -> bytes:
    """Read a regular file of at most ``limit`` bytes; raise ``error`` otherwise."""
    check_regular(path, error, hint=hint)
    with _reading(path, error, hint), open(path, "rb") as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise error(
            f"must not exceed {limit:,} bytes",
            code="file-unreadable",
            path=path,
            hint=hint,
        )
    return data


def recognise(data: bytes) -> str:
    """Name what a file is by its bytes: a kind of `MARKS`, a cube, an emission table or
    text; empty for all others.
    """
    for mark, kind in MARKS.items():
        if re.match(mark, data, re.DOTALL):
            return kind
    if data[8:9] == b"{":  # safetensors: the length of a header, and the header as JSON
        return next((kind for mark, kind in CONTAINERS.items() if mark in data), "")
    return "" if b"\0" in data else "text"


def file_digest(path: StrPath, error: type[UpliftError] = UpliftError) -> str:
    """Return the SHA-256 digest of a regular file in hexadecimal; raise ``error`` for
    others.
    """
    import hashlib

    check_regular(path, error, hint="name a file")
    with _reading(path, error, "name a file"), open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@contextlib.contextmanager
def _reading(path: StrPath, error: type[UpliftError], hint: str) -> Iterator[None]:
    """Translate the errors of the system."""
    try:
        yield
    except (FileNotFoundError, NotADirectoryError) as cause:
        raise error(
            "no such file", code="file-not-found", path=path, hint=hint
        ) from cause
    except (OSError, ValueError) as cause:  # a null byte in the path is a ValueError
        reason = getattr(cause, "strerror", None) or cause
        raise error(
            f"cannot be read: {reason}", code="file-unreadable", path=path, hint=hint
        ) from cause


def check_output(
    path: StrPath, *, inputs: Iterable[StrPath | None] = (), force: bool = False
) -> Path:
    """Check that a file can be written, before long work rather than after it.

    An existing file is accepted with ``force``, one of the ``inputs`` never
    (``output-is-input``). Names of inputs without a file, such as those of shipped
    atlases, are ignored.
    """
    if os.fspath(path) == "-":
        hint = "give a file name, or ./- for a file of this name"
        raise OutputError(
            "stands for standard output, which cannot hold a file", path=path, hint=hint
        )
    path = Path(path)
    refused = functools.partial(OutputError, path=path, hint="choose another name")
    try:
        status = path.stat()
    except FileNotFoundError:
        status = None
    # No permission, too long, with NUL, or a loop of links
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise refused(f"cannot be written: {reason}") from error
    if status is not None:
        if _is_one_of(status, inputs):
            problem = "is read as input and must not be replaced"
            raise refused(problem, code="output-is-input")
        if not stat.S_ISREG(status.st_mode):
            raise refused("is not a regular file")
        if not force:
            hint = "pass force=True to replace it, or choose another name"
            raise refused("exists already", code="file-exists", hint=hint)
    folder = path.resolve().parent
    if not folder.is_dir():
        raise refused(f"the folder {folder} does not exist", hint="create it first")
    if not os.access(folder, os.W_OK):
        raise refused(
            f"no permission to write in {folder}", hint="choose another folder"
        )
    return path


def _is_one_of(status: os.stat_result, paths: Iterable[StrPath | None]) -> bool:
    """Whether a file is one of others, by inode: links and other spellings of a path
    are the same file.
    """
    existing = [path for path in paths if path is not None and os.path.exists(path)]
    return any(os.path.samestat(status, os.stat(path)) for path in existing)


def write_text(text: str, path: StrPath, *, force: bool = False) -> None:
    """Write text as UTF-8 with LF line ends, atomically."""
    with atomic_write(path, force=force) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextlib.contextmanager
def atomic_write(path: StrPath, *, force: bool = False) -> Iterator[Path]:
    """Provide a temporary path that is renamed to ``path`` if the block succeeds, and
    removed if it fails.

    A replaced file keeps its permissions. A symbolic link is kept and its target
    replaced.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_write(Path(folder) / "notes.txt") as temporary:
    ...         _ = temporary.write_text("complete")
    ...     print((Path(folder) / "notes.txt").read_text())
    complete
    """
    path = check_output(path, force=force)
    target = path.resolve()
    temporary = target.with_name(
        f"{PREFIX.format(target.name[:40])}{os.urandom(4).hex()}.part"
    )
    _TEMPORARIES.add(temporary)
    try:
        remove_stale(target)
        temporary.touch(exist_ok=False)
        yield temporary
        # On disk before it gets its name: after a power cut the name stands for the old
        # content or for all of the new.
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        if target.exists():
            temporary.chmod(stat.S_IMODE(target.stat().st_mode) & 0o777)
        os.replace(temporary, target)
    except OutputError:
        raise
    except OSError as error:
        problem = f"cannot be written: {error.strerror or error}"
        raise OutputError(
            problem, path=path, hint="an existing file is unchanged"
        ) from error
    finally:
        temporary.unlink(missing_ok=True)
        _TEMPORARIES.discard(temporary)


def remove_stale(path: StrPath, seconds: float = DAY) -> None:
    """Remove the temporary files of writers to a path that have not changed for so
    long: their writers were killed.
    """
    target = Path(path).resolve()
    for entry in os.scandir(target.parent):
        if entry.name.startswith(
            PREFIX.format(target.name[:40])
        ) and entry.name.endswith(".part"):
            with contextlib.suppress(OSError):
                if time.time() - entry.stat().st_mtime >= seconds:
                    os.unlink(entry)


def remove_temporaries() -> None:
    """Remove the temporary files that this process is writing, before it ends without
    leaving its blocks.
    """
    for temporary in list(_TEMPORARIES):
        with contextlib.suppress(OSError):
            temporary.unlink()
