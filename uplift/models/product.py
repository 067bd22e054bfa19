"""Tall matrices times small ones. numpy's BLAS shares them out to threads, at several times their cost, and at a
hundred times where other processes want the cores too.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.sensor import Array

ALONE = 1 << 17
"""Multiplications that OpenBLAS starts no thread for; it begins at twice as many."""


def product(rows: Any, matrix: Any) -> Any:
    """``rows`` (n, K) @ ``matrix`` (K, N), for numpy and JAX arrays."""
    return _by_slices(rows, matrix) if rows.__array_namespace__() is np else rows @ matrix


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
