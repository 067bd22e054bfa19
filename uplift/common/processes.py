"""Child processes that end with their parent: pools of workers, and single calls that may crash or hang."""

import contextlib
import multiprocessing
import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext
from typing import Any, TypeVar

from uplift.common.files import remove_temporaries

Result = TypeVar("Result")
GRACE = 5.0
"""Seconds that a child may take to exit after its answer."""


class ChildError(Exception):
    """A child process crashed, or did not answer in time; the text states which."""


def call_in_child(function: Callable[..., Result], *arguments: Any, seconds: float) -> Result:
    """Call a function in a separate process, whose crash or hang leaves this process unharmed.

    The function and its arguments are pickled. Its exceptions are raised here; a child that crashes, or has no answer
    after ``seconds`` and is killed, raises `ChildError`.
    """
    with _spawning() as spawn:
        ours, theirs = spawn.Pipe()
        child = spawn.Process(target=_answer, args=(theirs, function, arguments), daemon=True)
        child.start()
    theirs.close()
    try:
        if not ours.poll(seconds):
            raise ChildError(f"no answer within {seconds:g} s")
        result, error = ours.recv()
        child.join(GRACE)
    except (EOFError, OSError) as lost:
        child.join(GRACE)
        code = child.exitcode or 0
        raise ChildError(f"crashed: signal {-code}" if code < 0 else f"crashed: exit code {code}") from lost
    finally:
        ours.close()
        if child.is_alive():
            child.kill()
            child.join()
    if error is not None:
        raise error
    return result


def _answer(pipe: Connection, function: Callable[..., object], arguments: tuple[object, ...]) -> None:
    """Send the result of a function, or its exception. Output and warnings of the child are dropped."""
    _tie(pipe)
    warnings.simplefilter("ignore")
    # Libraries of other languages write to the descriptors, not to sys.stdout.
    silence = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(silence, stream)
    try:
        pipe.send((function(*arguments), None))
    except Exception as error:
        pipe.send((None, error))


@contextlib.contextmanager
def tied_processes(count: int) -> Iterator[ProcessPoolExecutor]:
    """Start processes that end, and remove their temporary files, when the block raises or this process ends.

    A pipe ties them: the system closes its end in this process even if this process is killed.
    """
    with _spawning() as spawn:
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


@contextlib.contextmanager
def _spawning() -> Iterator[SpawnContext]:
    """Provide the context of new processes, which JAX needs: it cannot be forked.

    They load no module from the working folder in place of one of Python's. Later they get its sys.path.
    """
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        yield multiprocessing.get_context("spawn")
    finally:
        if before is None:
            os.environ.pop("PYTHONSAFEPATH", None)
        else:
            os.environ["PYTHONSAFEPATH"] = before


def _tie(reader: Connection) -> None:
    """End this worker with its parent, and not by the Ctrl-C that the terminal sends to all processes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in {"SIGTERM", "SIGHUP"} & {each.name for each in signal.Signals}:  # SIGHUP is not on Windows
        signal.signal(signal.Signals[name], lambda number, frame: _end(128 + number))
    threading.Thread(target=_wait, args=(reader,), daemon=True).start()


def _wait(reader: Connection) -> None:
    """Wait until the parent closes the pipe."""
    with contextlib.suppress(EOFError, OSError):
        reader.recv_bytes()
    _end(1)


def _end(code: int) -> None:
    remove_temporaries()
    os._exit(code)
