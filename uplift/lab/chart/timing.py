"""CPU time per colour, by the number of colours per call."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.lab.chart.task import Effort
from uplift.lab.timing import Spread, time_calls

MIN_RUNS = 3
MAX_LAPS = 15
"""Duration of all runs together, in units of `Effort.lap`, unless `MIN_RUNS` take longer."""
TRIAL = 512
"""Colours from which the duration of the first batch of more than one is estimated."""
INPUTS, INPUT_COLOURS = 64, 1 << 16
"""Different inputs of repeated calls: at most so many, with so many colours in all."""
REFERENCE = 65_536
"""Colours per call of the time by which cubes are recommended."""

Call = Callable[[Any], object]


def call_times(uplift: Call, dtype: str, effort: Effort, *, batch: bool) -> dict[str, float]:
    """Time calls with each number of colours of an effort, after one that warms up.

    Parameters
    ----------
    uplift : callable
        Function of colours (n, 3).
    dtype : str
        Data type of the colours.
    effort : Effort
        Numbers of colours, and limits.
    batch : bool
        Whether the function takes many colours at once; otherwise it loops over them.

    Returns
    -------
    dict of str to float
        ``ns_N`` for each N colours per call: CPU nanoseconds of all threads per colour, the median; with ``_least``,
        ``_most``, ``_runs``, and ``_colours``, fewer than N if N would take longer than ``effort.longest``.
    """
    numbers: dict[str, float] = {}
    found, shortened = None, False
    for size in effort.batches:
        if shortened and found is not None:  # as many colours per call as before
            numbers |= _numbers(size, *found)
            continue
        if found is not None and (found[1] > 1 or not batch):
            count = _count(size, found[0].median, effort)
        else:
            count = affordable(uplift, dtype, size, effort, batch=batch)
        found, shortened = (_timed(uplift, dtype, count, effort), count), count < size
        numbers |= _numbers(size, *found)
    reference = max((size for size in effort.batches if size <= REFERENCE), default=effort.batches[0])
    return numbers | {"time_ns": numbers[f"ns_{reference}"]}


def affordable(uplift: Call, dtype: str, size: int, effort: Effort, *, batch: bool = True) -> int:
    """Return the number of colours, at most ``size``, that a call of `Effort.longest` has, from a call with few."""
    count = min(size, TRIAL) if batch else 1
    rgb = _colours(1, count, dtype)[0]
    uplift(rgb)
    _, cpu = time_calls(lambda: uplift(rgb), 1)
    return _count(size, cpu.median / count, effort)


def _count(size: int, seconds: float, effort: Effort) -> int:
    return max(min(size, int(effort.longest / max(seconds, 1e-12))), 1)


def _timed(uplift: Call, dtype: str, count: int, effort: Effort) -> Spread:
    """CPU seconds per colour of calls with ``count`` colours."""
    inputs = _colours(max(1, min(INPUTS, INPUT_COLOURS // count)), count, dtype)
    _, once = time_calls(lambda: uplift(inputs[0]), 1)
    if once.min < effort.lap * MAX_LAPS:
        _, once = time_calls(lambda: uplift(inputs[0]), 1)
    calls = max(1, min(int(effort.lap / 5 / max(once.min, 1e-9)), 1000))

    def run() -> None:
        for rgb in islice(cycle(inputs), calls):
            uplift(rgb)

    runs = int(MAX_LAPS * effort.lap / max(calls * once.min, 1e-9))
    _, cpu = time_calls(run, min(max(runs, MIN_RUNS), effort.runs))
    return cpu.scaled(1 / (calls * count))


def _colours(inputs: int, count: int, dtype: str) -> NDArray[Any]:
    """Random RGB (inputs, count, 3)."""
    return np.random.default_rng(2).random((inputs, count, 3)).astype(dtype)


def _numbers(size: int, seconds: Spread, count: int) -> dict[str, float]:
    ns = seconds.scaled(1e9)
    key = f"ns_{size}"
    return {
        key: ns.median,
        f"{key}_least": ns.min,
        f"{key}_most": ns.max,
        f"{key}_runs": ns.runs,
        f"{key}_colours": count,
    }
