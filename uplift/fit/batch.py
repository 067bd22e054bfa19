"""Batches of few shapes, so that XLA compiles rarely, over all devices that JAX has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import jax
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from uplift.common.arrays import Indices

if TYPE_CHECKING:
    from uplift.common.arrays import Array

CPU_BATCH_ROWS, ACCELERATOR_BATCH_ROWS = (2048, 64), (1 << 17, 4096)
"""Rows per device: a large batch that fills a core's cache or keeps a GPU busy, and a small one for short rounds."""


def batches(rows: Indices, max_small: int = 4) -> Iterator[tuple[Indices, Indices]]:
    """Split rows into large batches and a remainder.

    Parameters
    ----------
    rows : ndarray of int, shape (n,)
        Row numbers.
    max_small : int, default 4
        The remainder is split into at most this many small batches; a longer one becomes a large batch.

    Yields
    ------
    batch : ndarray of int
        Row numbers of one batch.
    padded : ndarray of int
        The same, with the last row repeated up to the fixed size of the batch.
    """
    devices = len(jax.devices())
    sizes = CPU_BATCH_ROWS if jax.default_backend() == "cpu" else ACCELERATOR_BATCH_ROWS
    large, small = (devices * size for size in sizes)
    filled = len(rows) // large * large
    remainder = large if len(rows) - filled > max_small * small else small
    for first, last, width in ((0, filled, large), (filled, len(rows), remainder)):
        for begin in range(first, last, width):
            batch = rows[begin : min(begin + width, last)]
            yield batch, np.concatenate([batch, np.full(width - len(batch), batch[-1])])


def shard(array: Array) -> Any:
    """Distribute the rows of a batch over the devices."""
    return _place(array, "rows") if len(jax.devices()) > 1 else array


def replicate(constants: Any) -> Any:
    """Copy the constants of a computation to every device."""
    return _place(constants)


def _place(arrays: Any, *axes: str) -> Any:
    mesh = Mesh(np.array(jax.devices()), ("rows",))
    return jax.device_put(arrays, NamedSharding(mesh, PartitionSpec(*axes)))  # type: ignore[no-untyped-call]
