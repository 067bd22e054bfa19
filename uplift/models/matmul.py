"""Products of tall and small matrices without threads.

The BLAS of numpy distributes such products over threads at several times their cost, and at a hundred times if other
processes use the cores. Slices below its threshold stay on one thread.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.common.arrays import Array

SINGLE_THREAD_SIZE = 1 << 17
"""Multiplications per slice; OpenBLAS starts threads at twice as many."""


def matmul_rows(rows: Any, matrix: Any) -> Any:
    """Compute ``rows`` (n, K) @ ``matrix`` (K, N) of numpy or JAX arrays."""
    return _slice_rows(rows, matrix) if rows.__array_namespace__() is np else rows @ matrix


def matmul_columns(matrix: Any, columns: Any) -> Any:
    """Compute ``matrix`` (M, K) @ ``columns`` (K, n) of numpy or JAX arrays."""
    return _slice_columns(matrix, columns) if columns.__array_namespace__() is np else matrix @ columns


def _slice_rows(rows: Array, matrix: Array) -> Array:
    product = np.empty((len(rows), matrix.shape[1]))
    size = max(SINGLE_THREAD_SIZE // matrix.size, 1)
    full = len(rows) // size * size
    np.matmul(
        rows[:full].reshape(-1, size, rows.shape[1]),
        matrix,
        out=product[:full].reshape(-1, size, matrix.shape[1]),
    )
    np.matmul(rows[full:], matrix, out=product[full:])
    return product


def _slice_columns(matrix: Array, columns: Array) -> Array:
    product = np.empty((len(matrix), columns.shape[1]))
    size = max(SINGLE_THREAD_SIZE // matrix.size, 1)
    full = columns.shape[1] // size * size
    slices, targets = (array[:, :full].reshape(len(array), -1, size).swapaxes(0, 1) for array in (columns, product))
    np.matmul(matrix, slices, out=targets)
    np.matmul(matrix, columns[:, full:], out=product[:, full:])
    return product
