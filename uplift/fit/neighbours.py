"""Distances of entries to the nearest other one."""

import numpy as np

from uplift.common.arrays import Array

DENSE = 1000
"""Points whose distances from each other are computed at once, at most."""


def nearest_other(points: Array, order: float = 2) -> Array:
    """Distances (n,) from points (n, K) to the nearest other one by the norm of an
    order; infinite for a point alone.
    """
    if len(points) > DENSE:
        # Imported where it pays: SciPy takes as long as a small build.
        from scipy.spatial import KDTree

        found, _ = KDTree(points).query(points, k=2, p=order)
        return found[:, 1]
    apart = np.linalg.norm(points[:, None] - points, ord=order, axis=-1)
    np.fill_diagonal(apart, np.inf)
    return apart.min(axis=1, initial=np.inf)
