"""Distributions: counts in bins, and the few numbers that say most about them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Indices

BINS_PER_DECADE = 6
LINEAR_BINS = 24
STEPS = (1, 2, 2.5, 5, 10)
"""Bin widths that a reader can count by, in every decade."""


@dataclass(frozen=True, eq=False)
class Histogram:
    """``counts`` (B,) of values between ``edges`` (B + 1,), in the unit of the values; what lies outside the
    edges is counted in the outermost bins. The other numbers are of the values themselves."""

    edges: Array
    counts: Indices
    mean: float
    median: float
    p95: float
    largest: float

    @property
    def logarithmic(self) -> bool:
        """Whether the bins grow by a factor, not by a sum."""
        return bool(self.edges[0] > 0)


def histogram(values: ArrayLike, edges: Array) -> Histogram:
    """The distribution of values (n,), n ≥ 1, over edges (B + 1,)."""
    array = np.asarray(values, dtype=float)
    counts, _ = np.histogram(np.clip(array, edges[0], edges[-1]), edges)
    middle, high = np.quantile(array, (0.5, 0.95))
    return Histogram(
        edges, counts.astype(np.int64), float(array.mean()), float(middle), float(high), float(array.max())
    )


def log_edges(values: ArrayLike, floor: float) -> Array:
    """(B + 1,) edges in whole decades that hold the values (…) from ``floor`` on; two decades at least."""
    array = np.maximum(np.asarray(values, dtype=float), floor)
    low = np.floor(np.log10(array.min()))
    high = max(np.ceil(np.log10(array.max())), low + 2)
    return np.logspace(low, high, int(BINS_PER_DECADE * (high - low)) + 1)


def linear_edges(values: ArrayLike) -> Array:
    """(B + 1,) edges from 0 that hold the values (…), with steps a reader can count by."""
    wanted = max(float(np.max(values)), 1e-12) / LINEAR_BINS
    decade = 10.0 ** np.floor(np.log10(wanted))
    width = decade * next(step for step in STEPS if step * decade >= wanted * (1 - 1e-9))
    return width * np.arange(int(np.ceil(np.max(values) / width)) + 2)[: LINEAR_BINS + 1]
