"""Worker processes that end with their parent."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.connection import Connection
from types import FrameType

from uplift.common.files import remove_temporaries

__all__ = ["tied_processes"]

ENDED = 1
"""Exit code of a worker whose parent ended."""
SILENT = "ignore:resource_tracker:UserWarning"
"""Warnings of the process that frees what killed processes leave behind."""


@contextlib.contextmanager
def tied_processes(count: int) -> Iterator[ProcessPoolExecutor]:
    """Start processes that end, and remove their temporary files, when the block raises or this process ends.

    A pipe ties them: the system closes its end in this process even if this process is killed.

    Parameters
    ----------
    count : int
        Number of processes.

    Yields
    ------
    ProcessPoolExecutor
        The processes, started as they are needed.
    """
    spawn = multiprocessing.get_context("spawn")  # JAX cannot be forked
    _start_silent_tracker()
    reader, writer = spawn.Pipe(duplex=False)
    pool = ProcessPoolExecutor(count, mp_context=spawn, initializer=_tie, initargs=(reader,))
    try:
        yield pool
    except BaseException:
        writer.close()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        writer.close()
        reader.close()


def _start_silent_tracker() -> None:
    """Start multiprocessing's resource tracker, which takes its filter of warnings from this process."""
    if os.name != "posix":
        return
    from multiprocessing import resource_tracker

    sys.warnoptions.append(SILENT)
    try:
        resource_tracker.ensure_running()
    finally:
        sys.warnoptions.remove(SILENT)


def _tie(reader: Connection) -> None:
    """End this worker with its parent, and not by the Ctrl-C that the terminal sends to all processes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), _end)
    threading.Thread(target=_wait, args=(reader,), daemon=True).start()


def _wait(reader: Connection) -> None:
    """Wait until the parent closes the pipe."""
    with contextlib.suppress(EOFError, OSError):
        reader.recv_bytes()
    remove_temporaries()
    os._exit(ENDED)


def _end(number: int, frame: FrameType | None) -> None:
    remove_temporaries()
    os._exit(128 + number)
