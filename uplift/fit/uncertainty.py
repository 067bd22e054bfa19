"""Standard errors of answers, learnt from atlas entries that are left out (docs/mathematics.md, 7)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.kriging import Kernel, kernel_sums

KERNEL = Kernel(length=6.0, nugget=0.0)
"""Weights of the errors of entries around a colour."""
PRIOR_COUNT = 2.0
"""Weight of the mean error of all entries, in entries."""
COVERAGE = ((0.68, 1.0), (0.95, 2.0))
"""Shares of entries, when left out, whose error should be within one and within two standard errors."""
TRUST = 10.0
"""Entries at which half of a correction by coverage is applied, on a logarithmic scale."""
MIN_VARIANCE = 0.02
"""Lower limit of the variance assigned to a left-out entry."""


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Expected error of answers, estimated from left-out entries.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b* of the entries.
    squares : ndarray, shape (E,)
        ΔE00² of each entry when left out, per unit of variance.
    floor : float
        ΔE00² that remains at the entries themselves.
    """

    locations: Array
    squares: Array
    floor: float

    def __call__(self, lab: Array) -> Array:
        """Standard error (n,), ΔE00, at L*a*b* (n, 3)."""
        columns = np.stack([self.squares, np.ones(len(self.squares))], axis=1)
        sums, nearest = kernel_sums(lab, self.locations, columns, KERNEL)
        spread = (sums[:, 0] + PRIOR_COUNT * self.squares.mean()) / (sums[:, 1] + PRIOR_COUNT)
        return np.asarray(np.sqrt((1 - nearest**2) * spread + self.floor))


def uncertainty(locations: Array, left_out: Array, kept: Array) -> Uncertainty:
    """Estimate the uncertainty from the ΔE00 (E,) of entries at L*a*b* (E, 3), when left out and when kept."""
    from scipy.spatial.distance import cdist

    covariance = KERNEL(cdist(locations, locations))
    np.fill_diagonal(covariance, 0)
    variance = np.maximum(1 - covariance.max(axis=1) ** 2, MIN_VARIANCE)
    squares, floor = left_out**2 / variance, float((kept**2).mean())
    spread = (covariance @ squares + PRIOR_COUNT * squares.mean()) / (covariance.sum(axis=1) + PRIOR_COUNT)
    correction = _coverage_correction(left_out, np.sqrt(variance * spread + floor))
    return Uncertainty(locations, squares * correction**2, floor)


def _coverage_correction(errors: Array, expected: Array) -> float:
    """Factor that gives expected errors (E,) the `COVERAGE` of errors (E,), which have heavier tails than a normal.

    The quantiles are those of conformal prediction: they hold on average for one more entry.
    """
    count = len(errors)
    ratio = errors / np.maximum(expected, np.finfo(float).tiny)
    found = [
        np.quantile(ratio, min(share * (count + 1) / count, 1), method="higher") / multiple
        for share, multiple in COVERAGE
    ]
    square = np.square(found).mean()
    return float(square ** (0.5 * count / (count + TRUST))) if square > 0 else 1.0
