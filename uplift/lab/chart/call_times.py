"""CPU times of calls of a method by the number of colours per call."""

from collections.abc import Callable
from functools import partial
from itertools import cycle

import numpy as np

from uplift.common.arrays import Values
from uplift.common.text import pluralise
from uplift.extras.timing import TimingStats, run_call, time_short_call
from uplift.lab.chart.results import reference_batch
from uplift.lab.chart.task import Effort

GROWTH = 10
"""Factor between the numbers of colours from which the duration of a call is estimated.
"""
INPUTS = 64
"""Largest number of different inputs of repeated calls."""
INPUT_COLOURS = 1 << 16
"""Largest number of colours of all inputs."""
SAMPLE = 50
"""Colours of a large batch that are computed again in a small one."""
SAMPLE_TOLERANCE = 2e-5
"""Reflectance that rounding may change."""
UpliftRgb = Callable[[Values], Values]


class BrokenError(Exception):
    """An answer is wrong; the text gives the reason."""


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
        name = f"ns_{size}"
        numbers |= {name: ns.median, f"{name}_least": ns.min, f"{name}_most": ns.max}
        numbers |= {f"{name}_runs": ns.runs, f"{name}_colours": count}
    return numbers | {"time_ns": numbers[f"ns_{reference_batch(effort.batches)}"]}


def affordable(uplift: UpliftRgb, dtype: str, size: int, longest: float) -> int:
    """Return the number of colours, at most ``size``, of a call of ``longest`` CPU
    seconds.
    """
    count = 1
    while True:
        call = partial(uplift, _colours(1, count, dtype)[0])
        # The first call may compile.
        seconds = min(run_call(call).cpu for _ in range(2))
        if count == size or GROWTH * seconds > longest:
            return max(1, min(size, int(count * longest / max(seconds, 1e-9))))
        count = min(size, count * GROWTH)


def _colours(inputs: int, count: int, dtype: str) -> Values:
    """Random RGB (inputs, count, 3)."""
    return np.random.default_rng(2).random((inputs, count, 3)).astype(dtype)


def _time_batch(
    uplift: UpliftRgb, dtype: str, count: int, effort: Effort
) -> TimingStats:
    """Time calls with several inputs in turn, in ns per colour."""
    inputs = max(1, min(INPUTS, INPUT_COLOURS // count))
    rgb = _colours(inputs, count, dtype)
    _check_batch(uplift, rgb[0])
    turns = cycle(rgb)
    timing = time_short_call(lambda: uplift(next(turns)), effort.lap, effort.runs)
    return timing.cpu.scaled(1e9 / count)


def _check_batch(uplift: UpliftRgb, rgb: Values) -> None:
    """Check that a large batch has the spectra of a small one."""
    rows = np.unique(np.linspace(0, len(rgb) - 1, SAMPLE, dtype=int))
    difference = np.abs(uplift(rgb)[rows] - uplift(rgb[rows])).max()
    if not difference <= SAMPLE_TOLERANCE:
        raise BrokenError(
            f"{pluralise(len(rgb), 'colour')} per call give other reflectances than "
            f"{len(rows)}, by {difference:.2g}"
        )
