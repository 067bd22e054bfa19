"""Simple kriging of the deviation of atlas entries from smooth spectra (docs/mathematics.md, 7).

The deviation of an entry's multipliers from those of the smooth spectrum of its colour correlates between colours as
exp(−ΔE*ab / LENGTH). Far from all entries the deviation vanishes.

References
----------
Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25, and eq. 5.12 for leave-one-out.
"""

from __future__ import annotations

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array

LENGTH = 6.0
"""Correlation length in CIE L*a*b*, by cross-validation: docs/fidelity.md."""
NUGGET = 1e-3
"""Relative variance of noise: entries of the same colour and different spectra are averaged."""
BLOCK_NUMBERS = 1 << 20
"""Numbers of the kernel matrix held at a time."""
PRIOR_COUNT = 2.0
"""Weight of the mean error of all entries, in entries."""
MIN_VARIANCE = 0.02
"""Lower limit of the variance assigned to a left-out entry."""


@dataclass(frozen=True, eq=False)
class Kriging:
    """Interpolated deviation of the multipliers.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b* of the entries.
    weights : ndarray, shape (E, C)
        Weights of the kernel around each entry.
    length : float, default 6
        Correlation length in CIE L*a*b*.
    """

    locations: Array
    weights: Array
    length: float = LENGTH

    def __call__(self, lab: Array) -> Array:
        """Deviation of the multipliers (n, C) at L*a*b* (n, 3)."""
        return _kernel_sums(lab, self.locations, self.weights, self.length)[0]


def krige(locations: Array, deviations: Array, length: float = LENGTH) -> tuple[Kriging, Array]:
    """Fit the kriging of deviations (E, C) at L*a*b* (E, 3); with it, return its leave-one-out predictions (E, C)."""
    from scipy.linalg import cho_factor, cho_solve
    from scipy.linalg.lapack import dpotri

    factor = cho_factor(_kernel(locations, locations, length) + NUGGET * np.eye(len(locations)))
    weights = cho_solve(factor, deviations)
    inverse, _ = dpotri(factor[0], overwrite_c=True)
    return Kriging(locations, weights, length), deviations - weights / np.diag(inverse)[:, None]


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
        sums, nearest = _kernel_sums(lab, self.locations, columns)
        spread = (sums[:, 0] + PRIOR_COUNT * self.squares.mean()) / (sums[:, 1] + PRIOR_COUNT)
        return np.asarray(np.sqrt((1 - nearest**2) * spread + self.floor))


def uncertainty(locations: Array, left_out: Array, kept: Array) -> Uncertainty:
    """Estimate the uncertainty from the ΔE00 (E,) of entries at L*a*b* (E, 3), when left out and when kept."""
    kernel = _kernel(locations, locations)
    np.fill_diagonal(kernel, 0)
    variance = np.maximum(1 - kernel.max(axis=1) ** 2, MIN_VARIANCE)
    return Uncertainty(locations, left_out**2 / variance, float((kept**2).mean()))


def _kernel(first: Array, second: Array, length: float = LENGTH) -> Array:
    from scipy.spatial.distance import cdist

    return np.exp(cdist(first, second) / -length)


def _kernel_sums(lab: Array, locations: Array, columns: Array, length: float = LENGTH) -> tuple[Array, Array]:
    """Sums (n, K) of the entries' columns (E, K) weighted by the kernel at L*a*b* (n, 3), and its maximum (n,)."""
    rows = max(min(BLOCK_NUMBERS // max(len(locations), 1), len(lab)), 1)
    sums, nearest = np.empty((len(lab), columns.shape[1])), np.empty(len(lab))
    with jax.enable_x64(True):
        for first in range(0, len(lab), rows):
            part = slice(first, first + rows)
            count = len(lab[part])
            block = np.resize(lab[part], (rows, 3))  # the last block is padded: one shape is compiled
            found = _kernel_block(block, locations, columns, length)
            sums[part], nearest[part] = (np.asarray(array)[:count] for array in found)
    return sums, nearest


@jax.jit
def _kernel_block(
    lab: jax.Array, locations: jax.Array, columns: jax.Array, length: float
) -> tuple[jax.Array, jax.Array]:
    squared = ((lab[:, None] - locations[None]) ** 2).sum(axis=-1)
    kernel = jnp.exp(jnp.sqrt(squared) / -length)
    return kernel @ columns, kernel.max(axis=1)
