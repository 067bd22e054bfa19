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
    return Uncertainty(locations, left_out**2 / variance, float((kept**2).mean()))
