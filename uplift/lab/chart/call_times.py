"""CPU times of calls of a method by the number of colours per call."""

from collections.abc import Callable
from functools import partial
from itertools import cycle

import numpy as np

from uplift.common.arrays import Array, Values
from uplift.lab.chart.results import REFERENCE
from uplift.lab.chart.task import Effort
from uplift.lab.method import stopwatch
from uplift.lab.timing import TimingStats, time_laps

GROWTH = 10
"""Factor between the numbers of colours from which the duration of a call is estimated.
"""
INPUTS = 64
"""Largest number of different inputs of repeated calls."""
INPUT_COLOURS = 1 << 16
"""Largest number of colours of all inputs."""
UpliftRgb = Callable[[Array], Values]


def call_times(uplift: UpliftRgb, dtype: str, effort: Effort) -> dict[str, float]:
    """Time calls with each number of colours of an effort, in ns per colour.

    A call of more than `Effort.longest` seconds takes fewer colours. All larger batches
    then have its times.
    """
    numbers: dict[str, float] = {}
    count = last = 0
    for size in effort.batches:
        if count == last:
            count = affordable(uplift, dtype, size, effort.longest)
            ns = _time_batch(uplift, dtype, count, effort)
        last = size
        values = {
            "": ns.median,
            "_least": ns.min,
            "_most": ns.max,
            "_runs": ns.runs,
            "_colours": count,
        }
        numbers |= {f"ns_{size}{suffix}": value for suffix, value in values.items()}
    known = [size for size in effort.batches if size <= REFERENCE]
    reference = max(known, default=effort.batches[0])
    return numbers | {"time_ns": numbers[f"ns_{reference}"]}


def _time_batch(
    uplift: UpliftRgb, dtype: str, count: int, effort: Effort
) -> TimingStats:
    inputs = cycle(_colours(max(1, min(INPUTS, INPUT_COLOURS // count)), count, dtype))
    times = time_laps(lambda: uplift(next(inputs)), effort.lap, effort.runs)
    return times.scaled(1e9 / count)


def affordable(uplift: UpliftRgb, dtype: str, size: int, longest: float) -> int:
    """Return the number of colours, at most ``size``, of a call of ``longest`` CPU
    seconds.
    """
    count = 1
    while True:
        rgb = _colours(1, count, dtype)[0]
        uplift(rgb)
        _, seconds = stopwatch(partial(uplift, rgb))
        if count == size or GROWTH * seconds > longest:
            return max(1, min(size, int(count * longest / max(seconds, 1e-9))))
        count = min(size, count * GROWTH)


def _colours(inputs: int, count: int, dtype: str) -> Values:
    """Random RGB (inputs, count, 3)."""
    return np.random.default_rng(2).random((inputs, count, 3)).astype(dtype)
