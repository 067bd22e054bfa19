"""Long questions block by block, so that memory does not grow with them, on as many threads as are wanted."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from uplift.common.arrays import Array

BLOCK = 4096
"""Rows worked on at a time: what they need stays in a core's cache."""

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
    """``function`` of rows (…, K), as (…, width) of ``dtype``; numpy lets threads run beside one another."""
    flat = rows.reshape(-1, rows.shape[-1])
    found = np.empty((len(flat), width), dtype=dtype)

    def work(start: int) -> None:
        found[start : start + block] = function(flat[start : start + block])

    starts = range(0, len(flat), block)
    if min(threads, len(starts)) < 2:
        deque(map(work, starts), maxlen=0)
    else:
        with ThreadPoolExecutor(threads) as pool:
            deque(pool.map(work, starts), maxlen=0)
    return found.reshape(*rows.shape[:-1], width)
