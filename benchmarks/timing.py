"""Whole processes, and where the repository lies; `uplift.lab.timing` times the rest."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

from uplift.lab.timing import Spread, spread

ROOT = Path(__file__).parents[1]


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
