"""Child processes that end with their parent: pools of workers, and single calls that
may crash or hang.
"""

import contextlib
import multiprocessing
import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from typing import Any, TypeVar

from uplift.common.files import remove_temporaries

Result = TypeVar("Result")


class ChildError(Exception):
    """A child process crashed, or did not answer in time; the text states which."""


def call_in_child(
    function: Callable[..., Result], *arguments: Any, seconds: float
) -> Result:
    """Call a function in a separate process, whose crash or hang leaves this process
    unharmed.

    The function and its arguments are pickled. Its exceptions are raised here; a child
    that crashes, or has no answer after ``seconds`` and is killed, raises `ChildError`.
    """
    others = set(multiprocessing.active_children())
    try:
        with tied_processes(1) as pool:
            answer = pool.submit(_call_silently, function, arguments)
            (child,) = set(multiprocessing.active_children()) - others
            try:
                return answer.result(seconds)
            finally:
                child.kill()  # it may hang, also at its end
    except TimeoutError:
        raise ChildError(f"no answer within {seconds:g} s") from None
    except BrokenExecutor as lost:
        code = child.exitcode or 0
        raise ChildError(
            f"crashed: signal {-code}" if code < 0 else f"crashed: exit code {code}"
        ) from lost


def _call_silently(
    function: Callable[..., Result], arguments: tuple[object, ...]
) -> Result:
    """Call a function whose output and warnings are dropped."""
    warnings.simplefilter("ignore")
    # Libraries of other languages write to the descriptors, not to sys.stdout.
    silence = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(silence, stream)
    return function(*arguments)


@contextlib.contextmanager
def tied_processes(count: int) -> Iterator[ProcessPoolExecutor]:
    """Start processes that end, and remove their temporary files, when the block raises
    or this process ends.

    They are new ones, as JAX cannot be forked, and load no module from the working
    folder in place of one of Python's.
    """
    others = set(multiprocessing.active_children())
    before = os.environ.get("PYTHONSAFEPATH", "")
    os.environ["PYTHONSAFEPATH"] = "1"
    pool = ProcessPoolExecutor(
        count, mp_context=multiprocessing.get_context("spawn"), initializer=_tie
    )
    try:
        yield pool
    # Work that is not finished is not waited for: a signal ends the workers, which
    # remove their temporary files.
    except BaseException:
        for child in set(multiprocessing.active_children()) - others:
            child.terminate()
        raise
    finally:
        os.environ["PYTHONSAFEPATH"] = before
        pool.shutdown(cancel_futures=True)


def _tie() -> None:
    """End this worker with its parent, and not by the Ctrl-C that the terminal sends to
    all processes.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for kind in signal.Signals:
        if kind.name in ("SIGTERM", "SIGHUP"):  # the latter is not on Windows
            signal.signal(kind, lambda number, frame: _end(128 + number))
    threading.Thread(target=_wait, daemon=True).start()


def _wait() -> None:
    """Wait until the parent ends, also if it is killed."""
    if parent := multiprocessing.parent_process():
        parent.join()
    _end(1)


def _end(code: int) -> None:
    remove_temporaries()
    os._exit(code)
