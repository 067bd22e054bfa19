"""A target under many inputs, each within its time, all within their memory; what was not refused cleanly is kept."""

from __future__ import annotations

import contextlib
import resource
import shutil
import signal
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

import numpy as np

from tests.fuzz.target import Target
from uplift.common.errors import UpliftError, UpliftWarning

SECONDS = 5.0
"""Of the processor: an input that takes longer hangs, honest ones take milliseconds. Other processes do not count."""
MEGABYTES = 1024
"""Address space that inputs may take beside what the process has."""


class HangError(BaseException):
    """Out of time; no ``except Exception`` takes it for something else."""


@dataclass
class Tally:
    """What came of the inputs: taken as they were, refused by `UpliftError`, or failed, by kind with one example."""

    target: str
    inputs: int = 0
    taken: int = 0
    refused: int = 0
    failures: Counter[str] = field(default_factory=Counter)


def attack(target: Target, seed: int, inputs: range, folder: Path, kept: Path) -> Tally:
    """Try inputs ``inputs`` of a target in ``folder``; of each kind of failure the first is ``kept``."""
    tally, path = Tally(target.name), folder / "input"
    _limit_memory()
    with _alarm():
        for number in inputs:
            with warnings.catch_warnings(action="ignore"):
                target.write(np.random.default_rng([seed, number]), path)
            tally.inputs += 1
            failure = _try(target, path, tally)
            if failure:
                tally.failures[failure] += 1
                if tally.failures[failure] == 1:
                    shutil.copy(
                        path, kept / f"{target.name.replace(',', '').replace(' ', '-')}-{seed}-{number}"
                    )
    return tally


def _try(target: Target, path: Path, tally: Tally) -> str:
    """What went wrong, empty if nothing did."""
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # numpy warns of numbers that should not have passed
            warnings.simplefilter("ignore", UpliftWarning)
            target.use(path)
        tally.taken += 1
    except UpliftError as error:
        tally.refused += 1
        if "\n" in str(error):
            return "a message of several lines"
    except BaseException as error:  # whatever else: that is the question
        if isinstance(error, KeyboardInterrupt):
            raise
        frame = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} in {Path(frame.filename).name}, {frame.name}: {str(error)[:80]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return ""


@contextlib.contextmanager
def _alarm() -> Iterator[None]:
    def ring(number: int, frame: FrameType | None) -> None:
        raise HangError(f"more than {SECONDS:g} s")

    before = signal.signal(signal.SIGPROF, ring)
    try:
        yield
    finally:
        signal.signal(signal.SIGPROF, before)


def _limit_memory() -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + (MEGABYTES << 20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1]))
