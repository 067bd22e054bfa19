"""Timing of processes; `uplift.lab.timing` times functions."""

from __future__ import annotations

import os
import subprocess
import time

from uplift.lab.timing import Spread, spread


def process(command: list[str], runs: int, environment: dict[str, str] | None = None) -> tuple[Spread, float]:
    """Return the wall seconds of a process and its peak memory in MB (Linux counts in kB)."""
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
