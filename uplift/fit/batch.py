"""Batches of few shapes, so that XLA compiles rarely, over all devices that JAX has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import jax
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from uplift.common.arrays import Array

CPU_BATCH_ROWS, ACCELERATOR_BATCH_ROWS = (2048, 64), (1 << 17, 4096)
"""Rows per device: a large batch that fills a core's cache or keeps a GPU busy, and a small one for short rounds."""


def batches(count: int, max_small: int = 0) -> Iterator[tuple[slice, int]]:
    """Split rows into large batches and a remainder.

    Parameters
    ----------
    count : int
        Number of rows.
    max_small : int, default 0
        The remainder is split into at most this many small batches; a longer one becomes a large batch. A second width
        is a second program to compile or to load, which small batches must be worth.

    Yields
    ------
    rows : slice
        Rows of one batch.
    width : int
        Fixed number of rows that `shard` pads them to.
    """
    devices = len(jax.devices())
    sizes = CPU_BATCH_ROWS if jax.default_backend() == "cpu" else ACCELERATOR_BATCH_ROWS
    large, small = (devices * size for size in sizes)
    filled = count // large * large
    remainder = large if count - filled > max_small * small else small
    for first, last, width in ((0, filled, large), (filled, count, remainder)):
        for begin in range(first, last, width):
            yield slice(begin, min(begin + width, last)), width


def shard(rows: Array, width: int) -> Any:
    """Distribute the rows of a batch over the devices, with the last one repeated up to ``width``."""
    missing = width - len(rows)
    padded = np.concatenate([rows, np.repeat(rows[-1:], missing, axis=0)]) if missing else rows
    return _place(padded, "rows") if len(jax.devices()) > 1 else padded


def replicate(constants: Any) -> Any:
    """Copy the constants of a computation to every device."""
    return _place(constants) if len(jax.devices()) > 1 else jax.device_put(constants)


def _place(arrays: Any, *axes: str) -> Any:
    mesh = Mesh(np.array(jax.devices()), ("rows",))
    return jax.device_put(arrays, NamedSharding(mesh, PartitionSpec(*axes)))  # type: ignore[no-untyped-call]
