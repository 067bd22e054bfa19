"""Simple kriging of the deviation of atlas entries from a base predictor (docs/mathematics.md, 7).

References
----------
Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25, and eq. 5.12 for leave-one-out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array

REACH = 12.0
"""ΔE*ab within which a deviation that belongs to one entry alone fades away."""
JITTER = 1e-3
"""Relative variance of noise: entries of the same colour and different spectra are averaged."""
BLOCK_NUMBERS, BLOCK_ROWS = 1 << 20, 1 << 13
"""Numbers and rows of the kernel matrix that are held at a time, at most."""


@dataclass(frozen=True)
class Kernel:
    """Covariance of the deviations of two colours: exp(−d / length) + nugget · (1 − d / 12)⁴ (1 + 4 d / 12), d = ΔE*ab.

    The first term is common to the materials of an atlas. The second, the nugget, belongs to one entry: kriging keeps
    it at the colour of the entry and near it, and averages it elsewhere.

    Parameters
    ----------
    length : float
        Correlation length in CIE L*a*b*.
    nugget : float
        Variance of the second term.

    References
    ----------
    Wendland 1995, "Piecewise polynomial, positive definite and compactly supported radial functions of minimal degree".
    """

    length: Any
    nugget: Any

    def __call__(self, distance: Any) -> Any:
        """Evaluate the covariance.

        Parameters
        ----------
        distance : array
            ΔE*ab, of numpy or JAX.

        Returns
        -------
        array
        """
        xp = distance.__array_namespace__()
        share = xp.minimum(distance / REACH, 1.0)
        fade = (1 - share) ** 2
        return xp.exp(distance / -self.length) + self.nugget * fade * fade * (1 + 4 * share)


@dataclass(frozen=True, eq=False)
class Kriging:
    """Interpolated deviation.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b* of the entries.
    weights : ndarray, shape (E, C)
        Weights of the kernel around each entry.
    kernel : Kernel
        Covariance of the deviations.
    """

    locations: Array
    weights: Array
    kernel: Kernel

    def __call__(self, lab: Array) -> Array:
        """Deviation (n, C) at L*a*b* (n, 3)."""
        return kernel_sums(lab, self.locations, self.weights, self.kernel)[0]


def krige(locations: Array, deviations: Array, kernel: Kernel) -> tuple[Kriging, Array]:
    """Fit the kriging of deviations (E, C) at L*a*b* (E, 3); with it, return its leave-one-out errors (E, C)."""
    from scipy.spatial.distance import cdist

    weights, errors = leave_one_out(kernel(cdist(locations, locations)), deviations)
    return Kriging(locations, weights, kernel), errors


def leave_one_out(covariance: Array, deviations: Array) -> tuple[Array, Array]:
    """Solve for the kriging weights (E, C) of deviations (E, C), and for the errors (E, C) of each when left out."""
    from scipy.linalg import cho_factor, cho_solve
    from scipy.linalg.lapack import dpotri

    factor = cho_factor(covariance + JITTER * np.eye(len(covariance)))
    weights = cho_solve(factor, deviations)
    inverse, _ = dpotri(factor[0], overwrite_c=True)
    return weights, weights / np.diag(inverse)[:, None]


def kernel_sums(lab: Array, locations: Array, columns: Array, kernel: Kernel) -> tuple[Array, Array]:
    """Sums (n, K) of the entries' columns (E, K) weighted by the kernel at L*a*b* (n, 3), and its maximum (n,)."""
    rows = max(min(BLOCK_NUMBERS // max(len(locations), 1), BLOCK_ROWS), 1)
    sums, nearest = np.empty((len(lab), columns.shape[1])), np.empty(len(lab))
    with jax.enable_x64(True):
        for first in range(0, len(lab), rows):
            part = slice(first, first + rows)
            count = len(lab[part])
            block = lab[part] if count == rows else np.resize(lab[part], (rows, 3))  # one shape is compiled
            found = _kernel_block(kernel.length, kernel.nugget, block, locations, columns)
            sums[part], nearest[part] = (np.asarray(array)[:count] for array in found)
    return sums, nearest


@jax.jit
def _kernel_block(
    length: float, nugget: float, lab: jax.Array, locations: jax.Array, columns: jax.Array
) -> tuple[jax.Array, jax.Array]:
    squared = ((lab[:, None] - locations[None]) ** 2).sum(axis=-1)
    weights = Kernel(length, nugget)(jnp.sqrt(squared))
    return weights @ columns, weights.max(axis=1)
