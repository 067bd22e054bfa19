"""Timings with median and range, the environment in which they are taken, and records
of both.
"""

import contextlib
import json
import os
import platform
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from pydantic_core import to_jsonable_python

from uplift.common.version import version
from uplift.extras.files.csv import csv_text

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
MIN_RUNS = 3
"""Fewest runs."""
MAX_LAPS = 75
"""Duration of all runs in units of the shortest, unless `MIN_RUNS` take longer."""


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


def timing_stats(values: list[float]) -> TimingStats:
    """Summarise the values of several runs."""
    return TimingStats(statistics.median(values), min(values), max(values), len(values))


def time_calls(
    function: Callable[[], object], runs: int
) -> tuple[TimingStats, TimingStats]:
    """Measure wall and CPU seconds of repeated calls.

    The caller has called the function once to warm up. Asynchronous results must be
    complete when it returns.
    """
    wall = []
    cpu = []
    for _ in range(runs):
        begin = time.perf_counter()
        begin_cpu = time.process_time()
        function()
        wall.append(time.perf_counter() - begin)
        cpu.append(time.process_time() - begin_cpu)
    return timing_stats(wall), timing_stats(cpu)


def children_cpu(function: Callable[[], object]) -> float:
    """Measure the CPU seconds of the processes that a call starts and waits for."""
    before = sum(os.times()[2:4])  # user and system time of child processes
    function()
    return sum(os.times()[2:4]) - before


def time_laps(function: Callable[[], object], lap: float, runs: int) -> TimingStats:
    """Measure the CPU seconds of a call after one that warms up, by up to ``runs`` runs
    of at least ``lap`` seconds.
    """
    function()
    once = max(time_calls(function, 1)[1].median, 1e-7)
    calls = max(1, round(lap / once))

    def run() -> None:
        for _ in range(calls):
            function()

    affordable = max(MIN_RUNS, int(MAX_LAPS * lap / (calls * once)))
    return time_calls(run, min(affordable, runs))[1].scaled(1 / calls)


def time_process(
    command: list[str], runs: int, variables: dict[str, str] | None = None
) -> tuple[TimingStats, float]:
    """Measure the wall seconds of a process, and its peak memory in MB (Linux counts in
    kB).
    """
    wall = []
    peak = 0
    for _ in range(runs):
        begin = time.perf_counter()
        quiet = subprocess.DEVNULL
        child = subprocess.Popen(
            command, env=os.environ | (variables or {}), stdout=quiet, stderr=quiet
        )
        _, status, usage = os.wait4(child.pid, 0)
        wall.append(time.perf_counter() - begin)
        peak = max(peak, usage.ru_maxrss)
        if status:
            raise RuntimeError(f"{' '.join(command)} failed")
    return timing_stats(wall), peak / 1024


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
    if not _git("ls-files", "--", __file__):
        return "unknown"
    base = _git("merge-base", "HEAD", "main") or "HEAD"
    changed = _git("diff", "--name-only", base, "--", *CODE)
    return _git("log", "-1", "--format=%h", "--abbrev=12", base, "--", *CODE) + (
        " with changes" if changed else ""
    )


def commit_time(text: str) -> float:
    """Return the time of a commit, as of `commit`, in seconds; 0 if it is unknown."""
    return float(_git("log", "-1", "--format=%ct", text.partition(" ")[0], "--") or 0)


def _git(*arguments: str) -> str:
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


def records_csv(records: Sequence[Mapping[str, Any]]) -> str:
    """Format dictionaries with equal keys as CSV with a header line."""
    return csv_text(list(records[0]), [list(record.values()) for record in records])


def write_record(path: Path, command: str, **figures: Any) -> None:
    """Write figures with the command that measures them; ``environment`` is that of
    this process by default.
    """
    content = {"command": command, "environment": environment(), **figures}
    values = to_jsonable_python(content, fallback=lambda array: array.tolist())
    text = json.dumps(values, indent=1, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")
