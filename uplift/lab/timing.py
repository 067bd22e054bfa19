"""Honest numbers: repeats with median and spread, and where they were taken."""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

PACKAGES = ("numpy", "scipy", "jax", "colour-science", "safetensors", "uplift")
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
"""Read when numpy is imported. With matrices as small as these, more threads made colour-science twice as slow."""
SOURCES = Path(__file__).parents[1]


@dataclass(frozen=True)
class Spread:
    """Median, least and most of several runs."""

    median: float
    least: float
    most: float
    runs: int

    def __format__(self, spec: str) -> str:
        return f"{self.median:{spec}} ({self.least:{spec}}–{self.most:{spec}})"

    def scaled(self, factor: float) -> Spread:
        return Spread(self.median * factor, self.least * factor, self.most * factor, self.runs)


def spread(values: list[float]) -> Spread:
    return Spread(statistics.median(values), min(values), max(values), len(values))


def timed(function: Callable[[], object], runs: int) -> tuple[Spread, Spread]:
    """Wall and CPU seconds of warm runs; the caller has run it once, and what it returns is finished."""
    wall, cpu = [], []
    for _ in range(runs):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        function()
        wall.append(time.perf_counter() - begin)
        cpu.append(time.process_time() - begin_cpu)
    return spread(wall), spread(cpu)


def environment() -> dict[str, str]:
    """Machine, versions and commit."""
    cpu = next(
        (line.split(":")[1].strip() for line in _lines("/proc/cpuinfo") if line.startswith("model name")),
        platform.processor() or platform.machine(),
    )
    packages = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    return {
        "machine": f"{cpu}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}",
        "versions": f"Python {sys.version.split()[0]}, {packages}",
        "commit": commit(),
    }


def commit() -> str:
    """The commit that this code is of; 'unknown' where it does not lie in a working tree of its own."""
    if not _git("ls-files", "--", __file__):
        return "unknown"
    changed = _git("status", "--porcelain", "--", "uplift", "cli", "benchmarks")
    return _git("rev-parse", "--short=12", "HEAD") + (" with changes" if changed else "")


def _git(*words: str) -> str:
    """What git says of the sources; nothing where there is no git."""
    try:
        done = subprocess.run(["git", *words], cwd=SOURCES, capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout.strip()


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []
