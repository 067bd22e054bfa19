"""Fuzz campaign: run one target with many inputs under limits of time and memory, and keep inputs that fail."""

from __future__ import annotations

import contextlib
import resource
import shutil
import signal
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

import numpy as np

from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.text import printable

ROOT = Path(__file__).parents[2]
SECONDS = 5.0
"""Limit of processor time per input. Valid inputs take milliseconds."""
MEGABYTES = 1024
"""Limit of address space in addition to that of the process at the start."""


@dataclass(frozen=True)
class Target:
    """A reader under test: ``generate`` writes an input, ``use`` reads it and may raise `UpliftError` alone."""

    name: str
    generate: Callable[[np.random.Generator, Path], None]
    use: Callable[[Path], object]


class HangError(BaseException):
    """An input exceeded its time. Not an `Exception`, so that no handler of the target catches it."""


@dataclass
class Tally:
    """Numbers of inputs of a target: all, those used without an error, those that raised `UpliftError`, others."""

    target: str
    inputs: int = 0
    accepted: int = 0
    rejected: int = 0
    failures: Counter[str] = field(default_factory=Counter)

    def add(self, other: Tally) -> None:
        """Add the numbers of another tally of this target."""
        self.inputs += other.inputs
        self.accepted += other.accepted
        self.rejected += other.rejected
        self.failures += other.failures


def fuzz(target: Target, seed: int, inputs: range, folder: Path, kept: Path) -> Tally:
    """Run a target with numbered inputs, written to ``folder``; copy the first of each kind of failure to ``kept``."""
    tally, path = Tally(target.name), folder / "input"
    _limit_memory()
    with _time_limit_handler():
        for number in inputs:
            with warnings.catch_warnings(action="ignore"):
                target.generate(np.random.default_rng([seed, number]), path)
            failure = _run(target, path, tally)
            tally.inputs += 1
            if not failure:
                continue
            tally.failures[failure] += 1
            if tally.failures[failure] == 1:
                name = target.name.replace(",", "").replace(" ", "-")
                shutil.copy(path, kept / f"{name}-{seed}-{number}")
    return tally


def _run(target: Target, path: Path, tally: Tally) -> str:
    """Use one input and return a description of its failure, empty for none."""
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # warnings of numpy show missing validation
            warnings.simplefilter("ignore", UpliftWarning)
            target.use(path)
        tally.accepted += 1
    except UpliftError as error:
        tally.rejected += 1
        if printable(str(error)) != str(error):
            return "a message of several lines, or with control characters"
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} in {Path(frame.filename).name}, {frame.name}: {str(error)[:80]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return ""


@contextlib.contextmanager
def _time_limit_handler() -> Iterator[None]:
    def interrupt(number: int, frame: FrameType | None) -> None:
        raise HangError(f"more than {SECONDS:g} s")

    previous = signal.signal(signal.SIGPROF, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGPROF, previous)


def _limit_memory() -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + (MEGABYTES << 20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1]))
