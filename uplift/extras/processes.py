"""Child processes that end with their parent: pools of workers, and single calls that
may crash or hang.
"""

import multiprocessing
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any, Literal, TypeVar

from uplift.common.files import remove_temporaries

Result = TypeVar("Result")
MOST_ON_WINDOWS = 61
"""Processes that one call of Windows can wait for."""


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
    try:
        with TiedProcesses(1) as pool:
            answer = pool.submit(_call_silently, function, arguments)
            (child,) = pool.children
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


class TiedProcesses(ProcessPoolExecutor):
    """Processes that end, and remove their temporary files, when the block raises or
    this process ends.

    They are new ones, as JAX cannot be forked. With ``python -P`` or PYTHONSAFEPATH
    they load no module from the working folder in place of one of Python's, as this
    process does not: the command line sets it.

    Parameters
    ----------
    count : int
        Number of processes.
    """

    def __init__(self, count: int) -> None:
        context = _Recorder()
        self.children = context.children
        if sys.platform == "win32":
            count = min(count, MOST_ON_WINDOWS)
        super().__init__(count, mp_context=context, initializer=_tie)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> Literal[False]:
        """End the processes. Work that is not finished after an exception is not waited
        for: a signal ends the workers, which remove their temporary files.
        """
        if kind is not None:
            for child in self.children:
                if child.pid is not None:  # it may not have started
                    child.terminate()
        self.shutdown(cancel_futures=True)
        return False


class _Recorder(SpawnContext):
    """Start of new processes, which are kept in ``children``: those of other threads
    are not among them.
    """

    def __init__(self) -> None:
        super().__init__()
        self.children = list[SpawnProcess]()

    def Process(self, *args: Any, **options: Any) -> SpawnProcess:  # type: ignore[override] # noqa: N802
        """Make a process."""
        child = SpawnProcess(*args, **options)
        self.children.append(child)
        return child


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
