"""Batches of few shapes, so that little is compiled, over all devices that JAX has."""

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
"""Rows of a batch on each device: what the cache of a core holds or keeps a GPU busy, and a size for small rounds."""


def batches(rows: Indices, smaller: int = 4) -> Iterator[tuple[Indices, Indices]]:
    """Split ``rows``; with each part, the part with its last row repeated up to the size of a batch.

    Parts are of the larger size as long as they fill it; the rest is too, or up to so many of the ``smaller`` size.
    """
    devices = len(jax.devices())
    large, small = (
        devices * size
        for size in (CPU_BATCH_ROWS if jax.default_backend() == "cpu" else ACCELERATOR_BATCH_ROWS)
    )
    whole = len(rows) // large * large
    size = large if len(rows) - whole > smaller * small else small
    for first, last, width in ((0, whole, large), (whole, len(rows), size)):
        for begin in range(first, last, width):
            part = rows[begin : min(begin + width, last)]
            yield part, np.concatenate([part, np.full(width - len(part), part[-1])])


def shard(array: Array) -> Any:
    """An array whose rows are a batch, shared out over the devices."""
    return _place(array, "rows") if len(jax.devices()) > 1 else array


def replicate(constants: Any) -> Any:
    """Constants of a computation, on every device."""
    return _place(constants)


def _place(arrays: Any, *axes: str) -> Any:
    mesh = Mesh(np.array(jax.devices()), ("rows",))
    return jax.device_put(arrays, NamedSharding(mesh, PartitionSpec(*axes)))  # type: ignore[no-untyped-call]
