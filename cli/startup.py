"""Settings of the process: streams, signals, and variables that must precede the import of JAX or numpy."""

import io
import os
import signal
import sys
import warnings
from pathlib import Path

from uplift.common.errors import UpliftWarning
from uplift.common.files import remove_temporaries

ENDING = ("SIGTERM", "SIGHUP", "SIGBREAK")
"""Signals that end a command and its worker processes, as well as Ctrl-C."""


def prepare_process() -> None:
    """Prepare streams, signals and matplotlib for a command that has the process for itself."""
    _open_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # characters that the encoding lacks
    for name in ENDING:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:  # not under nohup
            signal.signal(number, _end)
    os.environ["MPLBACKEND"] = "agg"  # which needs no display
    sys.warnoptions.append("ignore:resource_tracker:UserWarning")  # of multiprocessing, about a process that was ended


def _open_closed_streams() -> None:
    """Open the null device in place of streams that the caller closed: another file would take their descriptors.

    It is opened such that each use of standard input and output is an error: nothing is lost without notice.
    """
    if sys.stdin is None:
        sys.stdin = open(os.open(os.devnull, os.O_WRONLY))  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = open(os.open(os.devnull, os.O_RDONLY), "w", encoding="utf-8")  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def _end(number: int, frame: object) -> None:
    """End the process at once: an exception might be dropped, in an import or a callback of JAX."""
    remove_temporaries()
    os._exit(128 + number)  # as shells report the signal


def hide_drawing_notes() -> None:
    """Hide matplotlib's notes on folders and fonts."""
    import logging

    logging.getLogger("matplotlib").addHandler(logging.NullHandler())


def enable_jit_cache() -> None:
    """Keep compiled JAX code in the user's cache folder, so that later commands do not compile it again.

    JAX runs the code that it finds there. A folder that other users can write to is not used, with a warning.
    """
    if "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    from platformdirs import user_cache_dir

    try:
        folder = Path(user_cache_dir("uplift"))
        if not folder.is_absolute():  # a user without a home compiles every time
            return
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except (OSError, RuntimeError):
        return
    if os.name == "posix" and (status.st_uid != os.getuid() or status.st_mode & 0o022):
        problem = f"other users can write to {folder}: compiled code is not kept there"
        hint = "remove the folder, or name another one by JAX_COMPILATION_CACHE_DIR"
        warnings.warn(UpliftWarning(problem, hint=hint), stacklevel=2)
        return
    os.environ["JAX_COMPILATION_CACHE_DIR"] = str(folder)
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")


def use_one_blas_thread() -> None:
    """Limit linear algebra of numpy to one thread, for timings."""
    from uplift.lab.timing import ONE_THREAD

    os.environ.update(ONE_THREAD)
