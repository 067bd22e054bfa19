"""Process large inputs in blocks of bounded memory, on several threads."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from uplift.common.arrays import Array

BLOCK = 4096
"""Rows per block: their temporary arrays fit into a core's cache."""

Function = Callable[[Array], NDArray[Any]]
"""From rows (k, K) to rows (k, N)."""


def blockwise(
    function: Function,
    rows: Array,
    width: int,
    dtype: DTypeLike = np.float64,
    threads: int = 1,
    block: int = BLOCK,
) -> NDArray[Any]:
    """Apply a function of rows block by block. numpy releases the GIL, so threads run in parallel.

    Parameters
    ----------
    function : callable
        From rows (k, K) to rows (k, width).
    rows : ndarray, shape (..., K)
        Input.
    width : int
        Number of columns of the result.
    dtype : dtype, default float64
        Type of the result.
    threads : int, default 1
        Number of threads.
    block : int, default 4096
        Rows per block.

    Returns
    -------
    ndarray, shape (..., width)
        The result; it does not depend on the number of threads.
    """
    flat = rows.reshape(-1, rows.shape[-1])
    result = np.empty((len(flat), width), dtype=dtype)

    def work(start: int) -> None:
        result[start : start + block] = function(flat[start : start + block])

    starts = range(0, len(flat), block)
    if min(threads, len(starts)) < 2:
        deque(map(work, starts), maxlen=0)
    else:
        from concurrent.futures import ThreadPoolExecutor  # slow to import

        with ThreadPoolExecutor(threads) as pool:
            deque(pool.map(work, starts), maxlen=0)
    return result.reshape(*rows.shape[:-1], width)
