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
    function: Function, rows: Array, width: int, dtype: DTypeLike = np.float64, threads: int = 1, block: int = BLOCK
) -> NDArray[Any]:
    """Apply a function, from rows (k, K) to rows (k, width), to rows (…, K) block by block: (…, width).

    numpy releases the GIL, so threads run in parallel. The result does not depend on their number.
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
