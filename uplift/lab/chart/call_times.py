"""CPU times of calls of a method by the number of colours per call."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import cycle

import numpy as np

from uplift.common.arrays import Values
from uplift.common.text import pluralise
from uplift.lab.chart.results import REFERENCE
from uplift.lab.chart.task import Effort
from uplift.lab.timing import TimingStats, run_call, time_short_call

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


@dataclass(frozen=True, eq=False)
class Call:
    """A function of colours (n, 3) in a data type."""

    uplift: Callable[[Values], Values]
    dtype: str

    def colours(self, count: int, inputs: int = 1) -> Values:
        """Return random RGB (inputs, count, 3)."""
        random = np.random.default_rng(2)
        return random.random((inputs, count, 3)).astype(self.dtype)


class BrokenError(Exception):
    """An answer is wrong; the text gives the reason."""


def call_times(call: Call, effort: Effort, batch: bool) -> dict[str, float]:
    """Time calls with each number of colours of an effort, in ns per colour.

    A call of more than `Effort.longest` seconds takes fewer colours. All larger batches
    then have its times. The spectra of a large ``batch`` are checked.
    """
    numbers: dict[str, float] = {}
    count = last = 0
    for size in effort.batches:
        if count == last:
            count = affordable(call, size, effort.longest)
            if batch and size <= REFERENCE:
                _check_batch(call, count)
            ns = _time_batch(call, count, effort)
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


def _check_batch(call: Call, count: int) -> None:
    """Check that a batch has the spectra of smaller ones."""
    (rgb,) = call.colours(count)
    rows = np.linspace(0, count - 1, SAMPLE, dtype=int)
    difference = np.abs(call.uplift(rgb)[rows] - call.uplift(rgb[rows])).max()
    if not difference <= SAMPLE_TOLERANCE:
        raise BrokenError(
            f"{pluralise(count, 'colour')} per call give other reflectances than "
            f"{SAMPLE}, by {difference:.2g}"
        )


def _time_batch(call: Call, count: int, effort: Effort) -> TimingStats:
    inputs = max(1, min(INPUTS, INPUT_COLOURS // count))
    rgb = cycle(call.colours(count, inputs))
    timing = time_short_call(lambda: call.uplift(next(rgb)), effort.lap, effort.runs)
    return timing.cpu.scaled(1e9 / count)


def affordable(call: Call, size: int, longest: float) -> int:
    """Return the number of colours, at most ``size``, of a call of ``longest`` CPU
    seconds.
    """
    count = 1
    while True:
        run = partial(call.uplift, call.colours(count)[0])
        run()
        seconds = run_call(run).cpu
        if count == size or GROWTH * seconds > longest:
            return max(1, min(size, int(count * longest / max(seconds, 1e-9))))
        count = min(size, count * GROWTH)
