"""Batches of few shapes, so that XLA compiles rarely, over all CPUs of JAX or the
devices that its user named; the compiled integrals of moments.
"""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from uplift.common.arrays import Array, blocks
from uplift.common.compilation import compiled
from uplift.common.machine import require_xla
from uplift.models.arithmetic import arctan
from uplift.models.duality import integrate, moments_from_multipliers
from uplift.models.minimum_norm import ForwardMap
from uplift.models.model import Model
from uplift.models.moments import Moments

CPU_ROWS = (4096, 256)
"""Rows of a batch per device, and of a chunk, which fits the cache of a CPU."""
ACCELERATOR_ROWS = (1 << 15, 1 << 15)
"""The same for an accelerator, which takes a whole batch."""
EVERYWHERE = PartitionSpec()  # type: ignore[no-untyped-call]
ROWS = PartitionSpec("rows")  # type: ignore[no-untyped-call]
MAX_NODES = 256
"""Larger rules of integration, which few spectra need, are not worth compiling."""
PART_NODES = 97
"""Nodes of the first rule. Other rules run in parts of as many: one program for all."""
CONVERGED = 1e-6
"""For lattices: moments differ by some 1e-9 at most, a sixtieth of the rounding to
single precision.
"""

jax.tree_util.register_dataclass(
    ForwardMap,
    ["basis", "sensor", "root", "inverse_root", "jacobian_basis"],
    meta_fields=["model"],
)


def map_batches(function: Callable[..., Any], constants: Any, *arrays: Any) -> Any:
    """Apply a function to constants and to trees of arrays (n, …), n > 0, and join the
    arrays that it returns.

    It is compiled for a chunk of rows, once if it is the same object in each call.
    Batches run side by side.
    """
    require_xla()
    named = _devices()
    devices = len(named)
    parts = []
    width, chunk = CPU_ROWS if named[0].platform == "cpu" else ACCELERATOR_ROWS
    total = len(jax.tree.leaves(arrays)[0])
    with jax.enable_x64(True), jax.default_device(named[0]):
        run = _program(function, chunk, named)
        for rows in blocks(total, devices * width):
            # Chunks beyond the counts are not computed.
            counts = np.clip(
                rows.stop - rows.start - width * np.arange(devices), 0, width
            )
            given = jax.tree.map(
                lambda array, rows=rows: _padded(array[rows], devices * width), arrays
            )
            parts.append(run(constants, counts, given))
        return jax.tree.map(lambda *joined: np.concatenate(joined)[:total], *parts)


def _devices() -> tuple[jax.Device, ...]:
    """The CPUs: accelerators make builds no shorter. The devices that
    ``JAX_PLATFORMS`` names, if any.
    """
    is_named = bool(jax.config.values["jax_platforms"])
    return tuple(jax.devices() if is_named else jax.devices("cpu"))


def _padded(array: Array, count: int) -> Array:
    """Repeat the last row, so that there are ``count``."""
    return (
        array
        if len(array) == count
        else array.take(np.arange(count), axis=0, mode="clip")
    )


@cache
def _program(
    function: Callable[..., Any], chunk: int, devices: tuple[jax.Device, ...]
) -> Callable[..., Any]:
    """Compile the loop over the chunks of a batch on each device."""
    traced_once = compiled(function)

    def run(constants: Any, counts: jax.Array, arrays: Any) -> Any:
        def compute(first: Any) -> Any:
            rows = jax.tree.map(
                lambda array: lax.dynamic_slice_in_dim(
                    array, first, chunk, allow_negative_indices=False
                ),
                arrays,
            )
            return traced_once(constants, *rows)

        def advance(carry: Any) -> Any:
            first, results = carry
            update = partial(
                lax.dynamic_update_slice_in_dim,
                start_index=first,
                axis=0,
                allow_negative_indices=False,
            )
            return first + chunk, jax.tree.map(update, results, compute(first))

        width = len(jax.tree.leaves(arrays)[0])
        empty = jax.tree.map(
            lambda some: jnp.zeros((width, *some.shape[1:]), some.dtype),
            jax.eval_shape(compute, 0),
        )
        return lax.while_loop(
            lambda carry: carry[0] < counts[0], advance, (jnp.asarray(0), empty)
        )[1]

    if len(devices) == 1:
        return compiled(run)
    mesh = Mesh(np.array(devices), ("rows",))
    given = (EVERYWHERE, ROWS, ROWS)
    run = jax.shard_map(run, mesh=mesh, in_specs=given, out_specs=ROWS, check_vma=False)
    shardings = tuple(NamedSharding(mesh, spec) for spec in given)
    return compiled(run, in_shardings=shardings)


def to_storage(model: Model, multipliers: Array) -> Array:
    """Coefficients (n, C) of many multipliers (n, C): `Model.to_storage`, less precise
    and several times faster.
    """
    if isinstance(model, Moments):
        return moments_from_multipliers(multipliers, _integrate, CONVERGED)
    return model.to_storage(multipliers)


def _integrate(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Compute `uplift.models.duality.integrate`."""
    count = len(synthesis)
    nodes, columns = analysis.shape
    if nodes > MAX_NODES + 1 or not len(multipliers):
        return integrate(multipliers, synthesis, analysis)
    moments = np.zeros((len(multipliers), columns))
    for first in range(0, nodes, PART_NODES):
        # Each step is as large as the first rule, which has two sets of moments: the
        # further nodes have no weight.
        step = slice(first, first + PART_NODES)
        points = np.zeros((count, PART_NODES))
        weights = np.zeros((PART_NODES, 2 * count))
        points[:, : nodes - first] = synthesis[:, step]
        weights[: nodes - first, :columns] = analysis[step]
        moments += map_batches(_weighted, (points, weights), multipliers)[:, :columns]
    return moments


def _weighted(rule: tuple[jax.Array, jax.Array], multipliers: jax.Array) -> jax.Array:
    synthesis, analysis = rule
    return (0.5 + arctan(multipliers @ synthesis) / jnp.pi) @ analysis
