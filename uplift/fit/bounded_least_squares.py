"""Linear least squares within bounds: spectra for given colours. The problem is convex, so the minimum is global.

Palettes are solved by it (Bergner, Möller & Drew 2004, section 3.3), and the reflectances of looks.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.machine import single_threaded_blas

TOLERANCE, MAX_ITERATIONS = 1e-12, 1000
"""Relative change at which the bounded solver stops, and its limit of iterations."""

Rows = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class BoundedProblem:
    """Least-squares problem: matrix (rows, n), values (rows,), and bounds low, high (n,) of x."""

    matrix: Array
    values: Array
    low: Array
    high: Array


def solve_bounded(problem: BoundedProblem) -> Array:
    """Minimise ‖M x − y‖ within the bounds, x (n,).

    Without bounds the pseudo-inverse gives the minimum of least norm. With bounds an active-set method does: BVLS of
    Stark & Parker 1995 in scipy's ``lsq_linear``. Independent blocks are solved one by one.
    """
    import scipy.linalg  # noqa: F401  whose BLAS is limited only if it is loaded

    x = np.zeros(problem.matrix.shape[1])
    with single_threaded_blas():
        for rows, columns in _independent_blocks(problem.matrix):
            matrix, values = problem.matrix[np.ix_(rows, columns)], problem.values[rows]
            bounds = problem.low[columns], problem.high[columns]
            if np.isinf(bounds).all() or not len(values):
                x[columns] = np.linalg.lstsq(matrix, values, rcond=None)[0]
            else:
                x[columns] = _bvls(matrix, values, bounds)
    return np.clip(x, problem.low, problem.high)  # removes rounding errors


def _independent_blocks(matrix: Array) -> Iterator[tuple[Rows, Rows]]:
    """Rows and columns of each block of M that shares no entry with the others."""
    from scipy.sparse import block_array, csr_array
    from scipy.sparse.csgraph import connected_components

    entries = csr_array(matrix != 0)
    rows = matrix.shape[0]
    count, labels = connected_components(block_array([[None, entries], [entries.T, None]]), directed=False)
    for label in range(count):
        yield np.flatnonzero(labels[:rows] == label), np.flatnonzero(labels[rows:] == label)


def _bvls(matrix: Array, values: Array, bounds: tuple[Array, Array]) -> Array:
    from scipy.optimize import lsq_linear

    result = lsq_linear(matrix, values, bounds, method="bvls", tol=TOLERANCE, max_iter=MAX_ITERATIONS)
    if not result.success:
        text = f"the solver stopped after {MAX_ITERATIONS} iterations: colours may be slightly off"
        warnings.warn(UpliftWarning(text, code="design-not-converged"), stacklevel=4)
    return np.asarray(result.x)
