"""Timings of calls and processes, and the environment in which they are taken.

numpy is not imported here: its threads are limited by `ONE_THREAD` before that.
"""

import contextlib
import os
import platform
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TypeVar

from uplift.common.version import version

PACKAGES = ("numpy", "scipy", "jax", "colour-science", "safetensors")
ONE_THREAD = {
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
}
"""Environment variables, read when numpy is imported. Matrices here are small: with
more threads colour-science took twice as long.
"""
CODE = (
    ":/uplift",
    ":/cli",
    ":/benchmarks",
    ":(top,exclude)uplift/lab/chart/measured.csv",
)
"""Files that measurements depend on: the code, without the measurements that are part
of the package.
"""
SOURCES = Path(__file__).parents[1]
RUNS = 5
Result = TypeVar("Result")


@dataclass(frozen=True)
class TimingStats:
    """Median, smallest and largest value of several runs."""

    median: float
    min: float
    max: float
    runs: int

    def scaled(self, factor: float) -> "TimingStats":
        """Multiply all values by a factor."""
        return TimingStats(
            self.median * factor, self.min * factor, self.max * factor, self.runs
        )


def timing_stats(values: Sequence[float]) -> TimingStats:
    """Summarise the values of several runs."""
    return TimingStats(statistics.median(values), min(values), max(values), len(values))


@dataclass(frozen=True)
class Run:
    """Wall and CPU seconds of a call or a process, and the peak memory of a process in
    MB.
    """

    wall: float
    cpu: float
    megabytes: float = 0.0


@dataclass(frozen=True)
class Timing:
    """Runs of one call or process. CPU seconds are those of all threads."""

    runs: tuple[Run, ...]

    @property
    def wall(self) -> TimingStats:
        """Wall seconds."""
        return timing_stats([run.wall for run in self.runs])

    @property
    def cpu(self) -> TimingStats:
        """CPU seconds."""
        return timing_stats([run.cpu for run in self.runs])

    @property
    def megabytes(self) -> float:
        """Peak memory of a process."""
        return max(run.megabytes for run in self.runs)


def stopwatch(function: Callable[[], Result]) -> tuple[Result, Run]:
    """Call a function; return its result and the time."""
    begin = time.perf_counter()
    begin_cpu = time.process_time()
    result = function()
    cpu = time.process_time() - begin_cpu
    return result, Run(time.perf_counter() - begin, cpu)


def run_call(function: Callable[[], object]) -> Run:
    """Time a call, whose result must be complete when it returns."""
    return stopwatch(function)[1]


def time_short_call(
    function: Callable[[], object], lap: float, runs: int = RUNS
) -> Timing:
    """Time a call after one that warms up, by runs that repeat it for at least ``lap``
    CPU seconds.
    """
    function()
    calls = max(1, round(lap / max(run_call(function).cpu, 1e-7)))

    def repeat() -> None:
        for _ in range(calls):
            function()

    laps = [run_call(repeat) for _ in range(runs)]
    return Timing(tuple(Run(run.wall / calls, run.cpu / calls) for run in laps))


def environment() -> dict[str, str]:
    """Describe where measurements are taken."""
    cpu = platform.processor() or platform.machine()
    with contextlib.suppress(OSError):
        text = Path("/proc/cpuinfo").read_text()
        if named := re.search(r"^model name[^:]*:([^:\n]*)", text, re.MULTILINE):
            cpu = named[1].strip()
    versions = [f"Python {sys.version.split()[0]}"]
    versions += [f"{name} {metadata.version(name)}" for name in PACKAGES]
    versions.append(f"uplift {version()}")
    system = f"{platform.system()} {platform.machine()}"
    return {
        "machine": f"{cpu}, {os.cpu_count()} cores, {system}",
        "versions": ", ".join(versions),
        "commit": commit(),
    }


def commit() -> str:
    """Return the last commit of the branch main that changed this code, which later
    rebasing leaves in the history.

    Commits of pages and tests alone do not count.
    """
    if not git("ls-files", "--", __file__):
        return "unknown"
    base = git("merge-base", "HEAD", "main") or "HEAD"
    changed = git("diff", "--name-only", base, "--", *CODE)
    return git("log", "-1", "--format=%h", "--abbrev=12", base, "--", *CODE) + (
        " with changes" if changed else ""
    )


def git(*arguments: str) -> str:
    """Output of git in the source folder, empty without git."""
    try:
        done = subprocess.run(
            ["git", *arguments],
            cwd=SOURCES,
            capture_output=True,
            text=True,
            check=False,
        )
    except OSError:
        return ""
    return done.stdout.strip()
