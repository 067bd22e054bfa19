"""Least squares within bounds: the minimum of convex problems, so the global one (Bergner, 3.3)."""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.threads import single_threaded_blas
from uplift.design.palette.equations import Equations

ENOUGH, MOST_STEPS = 1e-12, 1000
"""Relative change at which the bounded solver stops, and steps after which it gives up."""

Rows = NDArray[np.intp]


def solve(problem: Equations) -> Array:
    """x (n,) of least ‖M x − y‖ within the bounds.

    Without bounds by the pseudo-inverse: of several minima the shortest. With bounds by active sets (BVLS of Stark &
    Parker 1995 in scipy's ``lsq_linear``). What has no equation in common is solved apart.
    """
    found = np.zeros(problem.matrix.shape[1])
    with single_threaded_blas():
        for rows, columns in _apart(problem.matrix):
            part = Equations(
                problem.matrix[np.ix_(rows, columns)],
                problem.values[rows],
                problem.low[columns],
                problem.high[columns],
            )
            found[columns] = _solve_one(part)
    return np.clip(found, problem.low, problem.high)  # by rounding alone it may lie outside


def _apart(matrix: Array) -> Iterator[tuple[Rows, Rows]]:
    """Rows and columns of each part of M that shares nothing with the others."""
    from scipy.sparse import block_array, csr_array
    from scipy.sparse.csgraph import connected_components

    touched = csr_array(matrix != 0)
    rows = matrix.shape[0]
    count, labels = connected_components(block_array([[None, touched], [touched.T, None]]), directed=False)
    for label in range(count):
        yield np.flatnonzero(labels[:rows] == label), np.flatnonzero(labels[rows:] == label)


def _solve_one(problem: Equations) -> Array:
    from scipy.optimize import lsq_linear

    free = np.isinf(problem.low).all() and np.isinf(problem.high).all()
    if free or not len(problem.values):
        return np.asarray(np.linalg.lstsq(problem.matrix, problem.values, rcond=None)[0])
    found = lsq_linear(
        problem.matrix,
        problem.values,
        (problem.low, problem.high),
        method="bvls",
        tol=ENOUGH,
        max_iter=MOST_STEPS,
    )
    if not found.success:
        warnings.warn(
            f"stopped after {MOST_STEPS} steps: colours may be a little off", UpliftWarning, stacklevel=3
        )
    return np.asarray(found.x)
