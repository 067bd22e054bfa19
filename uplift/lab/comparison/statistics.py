"""The few numbers that stand for a distribution of colour differences (Kment 2011, 5.4)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Statistics:
    """ΔE00: mean, standard deviation, median, and the quantiles of 2.5, 25, 75 and 97.5 %."""

    mean: float
    deviation: float
    median: float
    q2_5: float
    q25: float
    q75: float
    q97_5: float

    def __iter__(self) -> Iterator[float]:
        """In the order of `HEADINGS`."""
        return iter(astuple(self))


HEADINGS = ("mean", "σ", "median", "2.5 %", "25 %", "75 %", "97.5 %")
"""Of tables."""


def statistics(errors: ArrayLike) -> Statistics:
    """Of errors (…), one at least."""
    errors = np.asarray(errors, dtype=float).ravel()
    low, first, median, third, high = (float(q) for q in np.quantile(errors, (0.025, 0.25, 0.5, 0.75, 0.975)))
    return Statistics(float(errors.mean()), float(errors.std()), median, low, first, third, high)
