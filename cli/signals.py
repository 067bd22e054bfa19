"""Signals that end a command: Ctrl-C, SIGTERM and SIGHUP raise `KeyboardInterrupt`, so that files are cleaned up.

An exception that a signal raises inside a callback of the interpreter, such as that of JAX for garbage collection, is
dropped by the interpreter. It is raised again a moment later, and at the next report of progress. For this the signal
is sent again until its exception is raised: one that arrives just before a system call does not end the call.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from types import FrameType
from typing import NoReturn

ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name))
"""Signals that end a command."""
RETRY_SECONDS = 0.02
"""Time until a signal is sent again."""
SENDER = "signals"
"""Name of the thread that sends signals again."""
IMPORT_SYSTEM = "<frozen importlib._bootstrap>"
"""File name of the code of the interpreter that imports modules."""

_received: list[int] = []
"""Signals that arrived since the command started."""
_unraised: list[int] = []
"""Signals whose exceptions were dropped or put off."""
_to_send: SimpleQueue[int | None] = SimpleQueue()
"""Signals to send again; None ends the thread that sends them. May be interrupted anywhere, as by a signal."""


class Interrupt(KeyboardInterrupt):
    """A signal that ends the command."""


@contextmanager
def ending_signals() -> Iterator[None]:
    """Raise `Interrupt` in the block for each of the signals `ENDING`, except those that the caller ignores."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _received.clear()
    _unraised.clear()
    handled = [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]  # nohup
    before = {number: signal.signal(number, _raise) for number in handled}
    hook = sys.unraisablehook

    def again(dropped: sys.UnraisableHookArgs) -> None:
        if _received and issubclass(dropped.exc_type, KeyboardInterrupt):
            _later(_received[0])
        else:
            hook(dropped)

    sys.unraisablehook = again
    threading.Thread(target=_send_again, name=SENDER, daemon=True).start()
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)
        _unraised.clear()  # a signal that was put off since the block ended has nothing left to end
        _to_send.put(None)


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


def _later(number: int) -> None:
    """Put a signal off for a moment."""
    _unraised.append(number)
    _to_send.put(number)


def _send_again() -> None:
    """Send each signal that was put off until its exception is raised."""
    while (number := _to_send.get()) is not None:
        while _unraised:
            time.sleep(RETRY_SECONDS)
            if _unraised:
                _send(number)


def _send(number: int) -> None:
    """Send a signal to the main thread, out of waiting for the system if that is possible."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


def _raise(number: int, frame: FrameType | None) -> None:
    """Raise `Interrupt`, at once or after a part of the program that must not be left."""
    _received.append(number)
    if _must_end(frame):
        _later(number)
        return
    _unraised.clear()
    raise Interrupt


def _must_end(frame: FrameType | None) -> bool:
    """Whether a frame is of an import, as an exception while JAX loads its libraries crashes them, or of this module.

    An exception in the hook for dropped exceptions is dropped as well.
    """
    while frame is not None:
        if frame.f_code.co_filename in (IMPORT_SYSTEM, _raise.__code__.co_filename):
            return True
        frame = frame.f_back
    return False
