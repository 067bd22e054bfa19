"""Settings of the process that must precede the import of JAX or numpy."""

import codecs
import contextlib
import io
import os
import signal
import stat
import sys
import threading
import time
import warnings
from itertools import chain
from pathlib import Path

from uplift.common.errors import UpliftWarning
from uplift.common.files import remove_temporaries
from uplift.common.text import printable

ENDING = ("SIGTERM", "SIGHUP", "SIGBREAK")
"""Signals that end a command and its worker processes, as well as Ctrl-C."""
GRACE = 5.0
"""Seconds between Ctrl-C and the end of a command that does not react."""
SPELLINGS = dict(zip("▁▂▃▄▅▆▇█Δ–−×±", "_.-:=+*#d--x~", strict=True)) | {
    "²": "^2",
    "³": "^3",
    "…": "...",
}
"""Characters of messages and plots of text in ASCII."""
_CACHES: set[Path] = set()
"""The folder of compiled code that is checked and in use."""


def prepare_process() -> None:
    """Prepare streams, signals and matplotlib of a process for one command."""
    _open_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_respell.__name__)
    for name in ENDING:
        number = getattr(signal, name, None)
        # not under nohup
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _end)
    if os.name == "posix":
        _watch_signals()
    # Commands have workers of their own; threads of numpy's BLAS and of XLA wait for
    # work by spinning.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    os.environ.setdefault("PJRT_NPROC", "1")
    os.environ["MPLBACKEND"] = "agg"  # which needs no display
    # figures do not depend on settings of the user
    os.environ["MATPLOTLIBRC"] = os.devnull
    # worker processes load no module from the working folder
    os.environ["PYTHONSAFEPATH"] = "1"
    if os.path.lexists("matplotlibrc"):  # matplotlib would obey it
        hide_drawing_notes()
        with contextlib.chdir(os.sep), contextlib.suppress(ImportError):
            import matplotlib  # noqa: F401
    # of multiprocessing, about a process that was ended
    sys.warnoptions.append("ignore:resource_tracker:UserWarning")


def _respell(error: UnicodeError) -> tuple[str, int]:
    """Spell characters that the encoding of a stream lacks in ASCII."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    letters = error.object[error.start : error.end]
    return "".join(SPELLINGS.get(letter, "?") for letter in letters), error.end


codecs.register_error(_respell.__name__, _respell)


def _open_closed_streams() -> None:
    """Open the null device in place of streams that the caller closed: another file
    would take their descriptors.

    It is opened such that each use of standard input and output is an error: nothing is
    lost without notice.
    """
    if sys.stdin is None:
        sys.stdin = open(os.open(os.devnull, os.O_WRONLY))  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = open(os.open(os.devnull, os.O_RDONLY), "w", encoding="utf-8")  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def _end(number: int, frame: object = None) -> None:
    """End the process at once: an exception might be dropped, in an import or a
    callback of JAX.
    """
    remove_temporaries()
    os._exit(128 + number)  # as shells report the signal


def _watch_signals() -> None:
    """End the process from a thread: Python's handlers wait for compiled code, which
    may decode a file for minutes.
    """
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)

    def watch() -> None:
        while True:
            number = os.read(reader, 1)[0]
            if number == signal.SIGINT:
                time.sleep(GRACE)
            if number == signal.SIGINT or signal.getsignal(number) is _end:
                _end(number)

    threading.Thread(target=watch, daemon=True).start()


def hide_drawing_notes() -> None:
    """Hide matplotlib's notes on folders and fonts."""
    import logging

    logging.getLogger("matplotlib").addHandler(logging.NullHandler())


def enable_jit_cache() -> None:
    """Keep compiled JAX code in the user's cache folder, so that later commands do not
    compile it again.

    JAX runs the code that it finds there. A folder that other users can change or
    replace is not used, with a warning.
    """
    if "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    from platformdirs import user_cache_dir

    folder = Path(user_cache_dir("uplift"))
    if not folder.is_absolute():  # a user without a home compiles every time
        return
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        # the folder that is checked, not a link to it
        folder = folder.resolve(strict=True)
        str(folder).encode()  # JAX takes UTF-8 only
        problem = _exposure(folder) if os.name == "posix" else None
    except (OSError, RuntimeError, UnicodeError) as error:
        problem = getattr(error, "strerror", None) or (
            "not UTF-8" if isinstance(error, UnicodeError) else "loop of links"
        )
    if problem:
        hint = (
            "correct or remove the folder, or name another one by "
            "JAX_COMPILATION_CACHE_DIR"
        )
        text = (
            "compiled code is not kept, which costs seconds each time: "
            f"{printable(str(folder))}: {problem}"
        )
        warnings.warn(UpliftWarning(text, hint=hint), stacklevel=2)
        return
    _CACHES.add(folder)
    os.environ["JAX_COMPILATION_CACHE_DIR"] = str(folder)
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")


def _exposure(folder: Path) -> str | None:
    """Return how other users could change the files of a folder, or put another folder
    in its place; None if not.
    """
    user = os.getuid()
    status = folder.stat()
    if status.st_uid != user or status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return "other users can write to it"
    for place in folder.parents:
        status = place.stat()
        shared = status.st_mode & stat.S_IWOTH or (
            status.st_mode & stat.S_IWGRP and not _is_private(status.st_gid)
        )
        is_sticky = status.st_mode & stat.S_ISVTX  # as /tmp is
        if status.st_uid not in (user, 0) or (shared and not is_sticky):
            return f"other users can write to {place}"
    return None


def _is_private(group: int) -> bool:
    """Whether a group is the user's own, as on systems whose umask is 0002."""
    import grp
    import pwd

    with contextlib.suppress(KeyError):  # a user without a name
        name = pwd.getpwuid(os.getuid()).pw_name
        entry = grp.getgrgid(group)
        return entry.gr_name == name and set(entry.gr_mem) <= {name}
    return False


def remove_compiled_code() -> bool:
    """Remove the compiled code that `enable_jit_cache` keeps, and return whether there
    was any.

    JAX never replaces an entry, also if it cannot read it, or if it is the code of
    another function.
    """
    entries = list(chain.from_iterable(folder.glob("*-cache") for folder in _CACHES))
    for entry in entries:
        entry.unlink(missing_ok=True)
    return bool(entries)


def use_one_blas_thread() -> None:
    """Limit linear algebra of numpy to one thread, for timings."""
    from uplift.extras.timing import ONE_THREAD

    os.environ.update(ONE_THREAD)
