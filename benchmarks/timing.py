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

ROOT = Path(__file__).parents[1]
PACKAGES = ("numpy", "scipy", "jax", "colour-science", "safetensors", "uplift")


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


def process(command: list[str], runs: int, environment: dict[str, str] | None = None) -> tuple[Spread, float]:
    """Wall seconds of a whole process and its peak memory in MB (Linux counts in kB)."""
    wall, peak = [], 0
    for _ in range(runs):
        begin = time.perf_counter()
        child = subprocess.Popen(
            command,
            env={**os.environ, **(environment or {})},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        _, status, usage = os.wait4(child.pid, 0)
        wall.append(time.perf_counter() - begin)
        peak = max(peak, usage.ru_maxrss)
        if status:
            raise RuntimeError(f"{' '.join(command)} failed")
    return spread(wall), peak / 1024


def circumstances() -> dict[str, str]:
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
    def git(*words: str) -> str:
        return subprocess.run(
            ["git", *words], cwd=ROOT, capture_output=True, text=True, check=False
        ).stdout.strip()

    changed = git("status", "--porcelain", "--", "uplift", "cli", "benchmarks")
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + (" with changes" if changed else "")


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []
