"""Tall matrices times small ones. numpy's BLAS shares them out to threads, at several times their cost, and at a
hundred times where other processes want the cores too.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.common.arrays import Array

ALONE = 1 << 17
"""Multiplications that OpenBLAS starts no thread for; it begins at twice as many."""


def matmul_rows(rows: Any, matrix: Any) -> Any:
    """``rows`` (n, K) @ ``matrix`` (K, N), for numpy and JAX arrays."""
    return _by_slices(rows, matrix) if rows.__array_namespace__() is np else rows @ matrix


def matmul_columns(matrix: Any, columns: Any) -> Any:
    """``matrix`` (M, K) @ ``columns`` (K, n), for numpy and JAX arrays."""
    return _by_columns(matrix, columns) if columns.__array_namespace__() is np else matrix @ columns


def _by_slices(rows: Array, matrix: Array) -> Array:
    found = np.empty((len(rows), matrix.shape[1]))
    size = max(ALONE // matrix.size, 1)
    whole = len(rows) // size * size
    np.matmul(
        rows[:whole].reshape(-1, size, rows.shape[1]),
        matrix,
        out=found[:whole].reshape(-1, size, matrix.shape[1]),
    )
    np.matmul(rows[whole:], matrix, out=found[whole:])
    return found


def _by_columns(matrix: Array, columns: Array) -> Array:
    found = np.empty((len(matrix), columns.shape[1]))
    size = max(ALONE // matrix.size, 1)
    whole = columns.shape[1] // size * size
    slices, places = (
        array[:, :whole].reshape(len(array), -1, size).swapaxes(0, 1) for array in (columns, found)
    )
    np.matmul(matrix, slices, out=places)
    np.matmul(matrix, columns[:, whole:], out=found[:, whole:])
    return found
