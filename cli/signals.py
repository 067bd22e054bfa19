"""Signals that end a command: Ctrl-C, SIGTERM and SIGHUP raise `KeyboardInterrupt`, so that files are cleaned up.

An exception that a signal raises inside a callback of the interpreter, such as that of JAX for garbage collection, is
dropped by the interpreter. It is raised again a moment later, and at the next report of progress.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

ENDING = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name)
)
"""Signals that end a command."""
RETRY_SECONDS = 0.02
IMPORT_SYSTEM = "<frozen importlib._bootstrap>"
"""File name of the code of the interpreter that imports modules."""

_received: list[int] = []
"""Signals that arrived since the command started."""


class Interrupt(KeyboardInterrupt):
    """A signal that ends the command."""


@contextmanager
def ending_signals() -> Iterator[None]:
    """Raise `Interrupt` in the block for each of the signals `ENDING`, except those that the caller ignores."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _received.clear()
    handled = [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]  # nohup
    before = {number: signal.signal(number, _raise) for number in handled}
    hook = sys.unraisablehook

    def again(dropped: sys.UnraisableHookArgs) -> None:
        if _received and issubclass(dropped.exc_type, KeyboardInterrupt):
            threading.Timer(RETRY_SECONDS, _send_again, (_received[0],)).start()
        else:
            hook(dropped)

    sys.unraisablehook = again
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def received() -> int | None:
    """Return the first signal that arrived, None if there is none."""
    return _received[0] if _received else None


def check() -> None:
    """Raise `Interrupt` if a signal has arrived, as its exception may have been dropped."""
    if _received:
        raise Interrupt


def end(code: int) -> NoReturn:
    """End the process, by the signal that ended the command if one did.

    A shell that runs the command in a loop thus ends the loop, and reports 128 and the number of the signal.
    """
    if _received and code == 128 + _received[0] and os.name == "posix":
        signal.signal(_received[0], signal.SIG_DFL)
        os.kill(os.getpid(), _received[0])
    sys.exit(code)  # also process 1 of a container, which signals do not end


def _send_again(number: int) -> None:
    """Send a signal to the main thread, out of waiting for the system if that is possible."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


def _raise(number: int, frame: FrameType | None) -> None:
    """Raise `Interrupt`, but only after an import: an exception while JAX loads its libraries crashes them."""
    _received.append(number)
    if _is_importing(frame):
        threading.Timer(RETRY_SECONDS, _send_again, (number,)).start()
        return
    raise Interrupt


def _is_importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename == IMPORT_SYSTEM:
            return True
        frame = frame.f_back
    return False
