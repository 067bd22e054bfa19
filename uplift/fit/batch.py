"""Batches of few shapes, so that XLA compiles rarely, over all devices of JAX; the compiled integrals of moments."""

from collections.abc import Callable, Iterator
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from uplift.common.arrays import Array
from uplift.models import Moments
from uplift.models.arithmetic import arctan
from uplift.models.duality import integrate, moments_from_multipliers
from uplift.models.minimum_norm import ForwardMap
from uplift.models.model import Model

CPU_BATCH_ROWS, ACCELERATOR_BATCH_ROWS = (2048, 64), (1 << 17, 4096)
"""Rows per device: a large batch that fills a core's cache or keeps a GPU busy, and a small one for short rounds."""
MAX_NODES = 256
"""Larger rules of integration, which few spectra need, are not worth compiling."""
PART_NODES = 97
"""Nodes of the first rule. Other rules run in parts of as many: one program for all."""
CONVERGED = 1e-6
"""For lattices: moments differ by some 1e-9 at most, a sixtieth of the rounding to single precision."""

jax.tree_util.register_dataclass(
    ForwardMap, ["basis", "sensor", "root", "inverse_root", "jacobian_basis"], meta_fields=["model"]
)


def map_batches(function: Callable[..., Any], constants: Any, *arrays: Any, max_small: int = 0) -> Any:
    """Apply a compiled function to constants and to trees of arrays (n, …), n > 0, and join the arrays it returns."""
    parts = []
    with jax.enable_x64(True):
        constants = _distribute(constants)
        for rows, width in batches(len(arrays[0]), max_small):
            given = jax.tree.map(lambda array, rows=rows, width=width: shard(array[rows], width), arrays)
            result = function(constants, *given)
            parts.append(jax.tree.map(lambda array, rows=rows: np.asarray(array)[: rows.stop - rows.start], result))
    return jax.tree.map(lambda *joined: np.concatenate(joined), *parts)


def batches(count: int, max_small: int = 0) -> Iterator[tuple[slice, int]]:
    """Split rows into large batches and a remainder: their slices, and the width that `shard` pads them to.

    The remainder is split into at most ``max_small`` small batches; a longer one becomes a large batch. A second width
    is a second program to compile or to load, which small batches must be worth.
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
    return _distribute(padded, "rows") if len(jax.devices()) > 1 else padded


def _distribute(arrays: Any, *axes: str) -> Any:
    if len(jax.devices()) == 1:
        return jax.device_put(arrays)
    mesh = Mesh(np.array(jax.devices()), ("rows",))
    return jax.device_put(arrays, NamedSharding(mesh, PartitionSpec(*axes)))  # type: ignore[no-untyped-call]


def to_storage(model: Model, multipliers: Array) -> Array:
    """Coefficients (n, C) of many multipliers (n, C): `Model.to_storage`, less precise and several times faster."""
    if isinstance(model, Moments):
        return moments_from_multipliers(multipliers, _integrate, CONVERGED)
    return model.to_storage(multipliers)


def _integrate(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Compute `uplift.models.duality.integrate`."""
    count, (nodes, columns) = len(synthesis), analysis.shape
    if nodes > MAX_NODES + 1 or not len(multipliers):
        return integrate(multipliers, synthesis, analysis)
    moments = np.zeros((len(multipliers), columns))
    for first in range(0, nodes, PART_NODES):
        # Each part is as large as the first rule, which has two sets of moments: the rest has no weight.
        part = slice(first, first + PART_NODES)
        points, weights = np.zeros((count, PART_NODES)), np.zeros((PART_NODES, 2 * count))
        points[:, : nodes - first], weights[: nodes - first, :columns] = synthesis[:, part], analysis[part]
        moments += map_batches(_weighted, (points, weights), multipliers)[:, :columns]
    return moments


@jax.jit
def _weighted(rule: tuple[jax.Array, jax.Array], multipliers: jax.Array) -> jax.Array:
    synthesis, analysis = rule
    return (0.5 + arctan(multipliers @ synthesis) / jnp.pi) @ analysis
