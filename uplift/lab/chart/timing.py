"""CPU time per colour, of many colours per call and of one per call."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle, islice

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.task import Effort
from uplift.lab.timing import Spread, time_calls

MIN_RUNS = 3
MAX_LAPS = 15
"""Duration of all runs together, in units of `Effort.lap`, unless `MIN_RUNS` take longer."""
TRIAL = 512
"""Colours from which the size of the batch is estimated."""
SINGLE_COLOURS = 64
"""Different colours for single calls."""


def batch_times(uplift: Callable[[Array], object], effort: Effort) -> dict[str, float]:
    """Measure calls with many colours, fewer of them for slow methods; ns of all threads per colour."""
    rgb = np.random.default_rng(2).random((effort.batch, 3))
    uplift(rgb[:1])
    _, trial = time_calls(lambda: uplift(rgb[:TRIAL]), 1)
    rgb = rgb[: max(int(MAX_LAPS * effort.lap * TRIAL / max(trial.median, 1e-9)), TRIAL)]
    return _numbers("batch", _repeated(lambda: uplift(rgb), len(rgb), effort), len(rgb))


def single_times(uplift: Callable[[Array], object], effort: Effort) -> dict[str, float]:
    """Measure calls with one colour; ns of all threads per call."""
    colours = np.random.default_rng(3).random((SINGLE_COLOURS, 1, 3))
    uplift(colours[0])
    _, once = time_calls(lambda: uplift(colours[1]), MIN_RUNS)
    calls = max(1, min(int(effort.lap / 5 / max(once.median, 1e-9)), 1000))

    def run() -> None:
        for rgb in islice(cycle(colours), calls):
            uplift(rgb)

    return _numbers("single", _repeated(run, calls, effort), calls)


def _repeated(run: Callable[[], object], colours: int, effort: Effort) -> Spread:
    """CPU seconds per colour, after a run that warms up and determines the number of the others."""
    _, first = time_calls(run, 1)
    runs = int(MAX_LAPS * effort.lap / max(first.median, 1e-9))
    _, cpu = time_calls(run, min(max(runs, MIN_RUNS), effort.runs))
    return cpu.scaled(1 / colours)


def _numbers(kind: str, seconds: Spread, colours: int) -> dict[str, float]:
    ns = seconds.scaled(1e9)
    return {
        f"{kind}_ns": ns.median,
        f"{kind}_ns_least": ns.min,
        f"{kind}_ns_most": ns.max,
        f"{kind}_runs": ns.runs,
        f"{kind}_colours": colours,
    }
