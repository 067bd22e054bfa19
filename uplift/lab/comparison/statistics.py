"""Statistics of colour differences.

References
----------
Kment 2011, section 5.4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import ArrayLike

HEADINGS = ("mean", "σ", "median", "2.5 %", "25 %", "75 %", "97.5 %")
"""Headings of tables, in the order of `Statistics`."""


@dataclass(frozen=True)
class Statistics:
    """Statistics of ΔE00.

    Parameters
    ----------
    mean, deviation, median : float
        Mean, standard deviation and median.
    q2_5, q25, q75, q97_5 : float
        Quantiles of 2.5, 25, 75 and 97.5 %.
    """

    mean: float
    deviation: float
    median: float
    q2_5: float
    q25: float
    q75: float
    q97_5: float

    def __iter__(self) -> Iterator[float]:
        return iter(astuple(self))


def compute_statistics(errors: ArrayLike) -> Statistics:
    """Compute the statistics of errors.

    Parameters
    ----------
    errors : array_like
        At least one ΔE00.

    Returns
    -------
    Statistics
        Mean, standard deviation and quantiles.

    Examples
    --------
    >>> compute_statistics([1, 2, 3]).mean
    2.0
    """
    values = np.asarray(errors, dtype=float).ravel()
    low, first, median, third, high = np.quantile(values, (0.025, 0.25, 0.5, 0.75, 0.975)).tolist()
    return Statistics(float(values.mean()), float(values.std()), median, low, first, third, high)
