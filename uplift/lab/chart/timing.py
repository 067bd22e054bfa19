"""CPU time per colour, of many colours at once and of one at a time; the caller has checked the answers."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle, islice

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.task import Effort
from uplift.lab.timing import Spread, timed

FEWEST_RUNS = 3
PATIENCE = 15
"""Laps that all runs together may take, if they are more than the fewest."""
TRIAL = 512
"""Colours that tell how many there is patience for."""
CALLS = 64
"""Different colours asked one at a time."""

Times = dict[str, float]


def batch_times(ask: Callable[[Array], object], effort: Effort) -> Times:
    """Of as many random colours as the effort has, fewer of slow methods; ns of all threads per colour."""
    rgb = np.random.default_rng(2).random((effort.batch, 3))
    ask(rgb[:1])
    _, trial = timed(lambda: ask(rgb[:TRIAL]), 1)
    rgb = rgb[: max(int(PATIENCE * effort.lap * TRIAL / max(trial.median, 1e-9)), TRIAL)]
    return _numbers("batch", *_repeated(lambda: ask(rgb), len(rgb), effort))


def single_times(ask: Callable[[Array], object], effort: Effort) -> Times:
    """Of one colour a call, after one another; ns of all threads per call."""
    colours = np.random.default_rng(3).random((CALLS, 1, 3))
    ask(colours[0])
    _, once = timed(lambda: ask(colours[1]), FEWEST_RUNS)
    calls = max(1, min(int(effort.lap / 5 / max(once.median, 1e-9)), 1000))

    def several() -> None:
        for rgb in islice(cycle(colours), calls):
            ask(rgb)

    return _numbers("single", *_repeated(several, calls, effort))


def _repeated(run: Callable[[], object], colours: int, effort: Effort) -> tuple[Spread, int]:
    """CPU seconds per colour, after a run that warms up and tells how many more there may be."""
    _, first = timed(run, 1)
    runs = int(PATIENCE * effort.lap / max(first.median, 1e-9))
    _, cpu = timed(run, min(max(runs, FEWEST_RUNS), effort.runs))
    return cpu.scaled(1 / colours), colours


def _numbers(kind: str, seconds: Spread, colours: int) -> Times:
    ns = seconds.scaled(1e9)
    return {
        f"{kind}_ns": ns.median,
        f"{kind}_ns_least": ns.least,
        f"{kind}_ns_most": ns.most,
        f"{kind}_runs": ns.runs,
        f"{kind}_colours": colours,
    }
