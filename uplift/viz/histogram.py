"""Histograms, and the statistics shown with them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Indices

BINS_PER_DECADE = 6
LINEAR_BINS = 24
STEPS = (1, 2, 2.5, 5, 10)
"""Bin widths in units of a power of ten."""


@dataclass(frozen=True, eq=False)
class Histogram:
    """Distribution of values.

    Parameters
    ----------
    edges : ndarray, shape (B + 1,)
        Edges of the bins.
    counts : ndarray of int, shape (B,)
        Values per bin; values outside the edges are counted in the outermost bins.
    mean, median, p95, largest : float
        Mean, median, 95 % quantile and maximum of the values.
    """

    edges: Array
    counts: Indices
    mean: float
    median: float
    p95: float
    largest: float

    @property
    def logarithmic(self) -> bool:
        """Return whether the edges are a geometric series."""
        return bool(self.edges[0] > 0)


def make_histogram(values: ArrayLike, edges: Array) -> Histogram:
    """Count values in bins.

    Parameters
    ----------
    values : array_like, shape (n,)
        At least one value.
    edges : ndarray, shape (B + 1,)
        Edges of the bins.

    Returns
    -------
    Histogram
        Counts and statistics.

    Examples
    --------
    >>> make_histogram([0.5, 1.5, 9.0], np.array([0.0, 1.0, 2.0])).counts.tolist()
    [1, 2]
    """
    array = np.asarray(values, dtype=float)
    counts, _ = np.histogram(np.clip(array, edges[0], edges[-1]), edges)
    median, p95 = np.quantile(array, (0.5, 0.95)).tolist()
    return Histogram(edges, counts.astype(np.int64), float(array.mean()), median, p95, float(array.max()))


def log_edges(values: ArrayLike, floor: float) -> Array:
    """Choose logarithmic bins.

    Parameters
    ----------
    values : array_like
        Values that the bins contain.
    floor : float
        Smaller values are treated as this one.

    Returns
    -------
    ndarray, shape (B + 1,)
        Edges over whole decades, at least two of them.
    """
    array = np.maximum(np.asarray(values, dtype=float), floor)
    low = np.floor(np.log10(array.min()))
    high = max(np.ceil(np.log10(array.max())), low + 2)
    return np.logspace(low, high, int(BINS_PER_DECADE * (high - low)) + 1)


def linear_edges(values: ArrayLike) -> Array:
    """Choose linear bins with round widths.

    Parameters
    ----------
    values : array_like
        Values of at least 0 that the bins contain.

    Returns
    -------
    ndarray, shape (B + 1,)
        Edges from 0.

    Examples
    --------
    >>> linear_edges([0.0, 0.05]).round(4).tolist()[:3]
    [0.0, 0.0025, 0.005]
    """
    target = max(float(np.max(values)), 1e-12) / LINEAR_BINS
    decade = 10.0 ** np.floor(np.log10(target))
    width = decade * next(step for step in STEPS if step * decade >= target * (1 - 1e-9))
    return width * np.arange(int(np.ceil(np.max(values) / width)) + 2)[: LINEAR_BINS + 1]
