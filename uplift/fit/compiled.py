"""Batches as programs of JAX, over all its devices: for large lattices, and for solvers of optimistix.

Programs have few shapes, so that XLA compiles rarely.
"""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import equinox
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from uplift.common.arrays import blocks
from uplift.models.minimum_norm import ForwardMap

CPU_ROWS, ACCELERATOR_ROWS = (4096, 256), (1 << 15, 1 << 15)
"""Rows of a batch per device, and of a chunk: that of a CPU fits its cache, an accelerator takes a whole batch."""
EVERYWHERE, ROWS = PartitionSpec(), PartitionSpec("rows")  # type: ignore[no-untyped-call]

jax.tree_util.register_dataclass(
    ForwardMap, ["basis", "sensor", "root", "inverse_root", "jacobian_basis"], meta_fields=["model"]
)


def map_batches(function: Callable[..., Any], constants: Any, *arrays: Any) -> Any:
    """Compute `uplift.fit.batch.map_batches`, compiled for a chunk of rows, once if the function is the same object.

    Batches run side by side.
    """
    devices, parts = len(jax.devices()), []
    width, chunk = CPU_ROWS if jax.default_backend() == "cpu" else ACCELERATOR_ROWS
    with jax.enable_x64(True):
        run, constants = _program(function, chunk, devices), _place(constants, EVERYWHERE)
        for rows in blocks(len(jax.tree.leaves(arrays)[0]), devices * width):
            # The last row is repeated. Chunks beyond the counts are not computed.
            count, last = rows.stop - rows.start, rows.stop - 1
            own = np.minimum(np.arange(rows.start, rows.start + devices * width), last)
            counts = np.clip(count - width * np.arange(devices), 0, width)
            given = jax.tree.map(lambda array, own=own: array[own], arrays)
            parts.append((count, run(constants, *_place((counts, given), ROWS))))
        parts = [jax.tree.map(lambda array, count=count: np.asarray(array)[:count], part) for count, part in parts]
    return jax.tree.map(lambda *joined: np.concatenate(joined), *parts)


@cache
def _program(function: Callable[..., Any], chunk: int, devices: int) -> Callable[..., Any]:
    """Compile the loop over the chunks of a batch on each device."""
    traced_once = jax.jit(function)

    def run(constants: Any, counts: jax.Array, arrays: Any) -> Any:
        def compute(first: Any) -> Any:
            rows = jax.tree.map(lambda array: lax.dynamic_slice_in_dim(array, first, chunk), arrays)
            return traced_once(constants, *rows)

        def advance(carry: Any) -> Any:
            first, results = carry
            update = partial(lax.dynamic_update_slice_in_dim, start_index=first, axis=0)
            return first + chunk, jax.tree.map(update, results, compute(first))

        width = len(jax.tree.leaves(arrays)[0])
        empty = jax.tree.map(lambda some: jnp.zeros((width, *some.shape[1:]), some.dtype), jax.eval_shape(compute, 0))
        return lax.while_loop(lambda carry: carry[0] < counts[0], advance, (jnp.asarray(0), empty))[1]

    if devices > 1:
        run = jax.shard_map(run, mesh=_mesh(), in_specs=(EVERYWHERE, ROWS, ROWS), out_specs=ROWS, check_vma=False)
    return jax.jit(run)


def _place(arrays: Any, spec: PartitionSpec) -> Any:
    """Put arrays on the devices."""
    if len(jax.devices()) == 1:
        return jax.device_put(arrays)
    return jax.device_put(arrays, NamedSharding(_mesh(), spec))  # type: ignore[no-untyped-call]


def _mesh() -> Mesh:
    return Mesh(np.array(jax.devices()), ("rows",))


def repeat_step(step: Callable[..., Any], is_done: Callable[..., Any], y: Any, state: Any, max_steps: Any) -> Any:
    """Take steps of `uplift.fit.solver.iterate` in a loop of XLA."""
    arrays, static = equinox.partition(state, equinox.is_array)

    def advance(carry: Any) -> Any:
        count, y, arrays = carry
        y, state = step(y, equinox.combine(arrays, static))
        return count + 1, y, equinox.filter(state, equinox.is_array)

    def unfinished(carry: Any) -> Any:
        count, _, arrays = carry
        return (count < max_steps) & ~is_done(equinox.combine(arrays, static))

    count, y, arrays = lax.while_loop(unfinished, advance, (jnp.asarray(0), y, arrays))
    return y, equinox.combine(arrays, static), count
