"""Many small least-squares problems at once: multipliers that reach their colours (docs/mathematics.md, 5).

Points travel in batches of fixed shapes, a few damped steps a pass; those that have arrived leave.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array
from uplift.fit.batch import batches, replicate, shard
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, minimum_norm_step, residual
from uplift.models.roots import MAX_MULTIPLIER

STEPS, MORE_STEPS = 2, 8
"""Damped steps a pass: of many points most have arrived after two; of few it costs more to ask than to go on."""
FEW = 1024
"""As many points are few."""
SMALLER = 12
"""Small batches that together take less than a large one, which goes on for as long as its last point does."""
FIRST_DAMPING = 1e-6
"""μ at the start; a quarter of it after a step that helped, four times after one that did not."""


GAIN, PATIENCE = 1e-3, 8
"""A point leaves when this many passes on end have each brought less than this share of its distance.

Unrealisable points, of which wide gamuts have many, would otherwise stay to the last pass.
"""

State = tuple[jax.Array, jax.Array, jax.Array, jax.Array]
"""Steps taken, multipliers, damping, residual."""


class Solution(NamedTuple):
    """Multipliers (n, C) and their distance (n,), max |target − RGB|."""

    multipliers: Array
    distance: Array


def solve(
    model: Model, forward: ForwardMap, start: Array, target: Array, *, tolerance: float, passes: int
) -> Solution:
    """Move multipliers ``start`` (n, C) to linear RGB ``target`` (n, 3), to ``tolerance`` where it can be had.

    No point ends further from its target than it began. That some do not converge is no error: the
    distance says so.
    """
    multipliers, damping = start.copy(), np.full(len(start), FIRST_DAMPING)
    distance = np.full(len(start), np.inf)
    stale = np.zeros(len(start), dtype=np.int64)
    left = np.arange(len(start))
    with jax.enable_x64(True):
        constants = replicate(forward)
        for _ in range(passes):
            before = distance[left]
            steps = MORE_STEPS if len(left) <= FEW else STEPS
            for rows, padded in batches(left, SMALLER):
                batch = (shard(array[padded]) for array in (multipliers, damping, target))
                found = _advance(model, constants, *batch, tolerance, steps)
                for whole, part in zip((multipliers, damping, distance), found, strict=True):
                    whole[rows] = np.asarray(part)[: len(rows)]
            stale[left] = np.where(distance[left] > (1 - GAIN) * before, stale[left] + 1, 0)
            left = left[(distance[left] > tolerance) & (stale[left] < PATIENCE)]
            if not left.size:
                break
    return Solution(multipliers, distance)


@partial(jax.jit, static_argnums=0)
def _advance(
    model: Model,
    forward: ForwardMap,
    multipliers: jax.Array,
    damping: jax.Array,
    target: jax.Array,
    tolerance: float,
    steps: int,
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Up to ``steps`` damped steps; a step counts only where it lowers the squared distance."""

    def damped_step(state: State) -> State:
        count, here, damping, off = state
        there = here + minimum_norm_step(model, forward, here, off, damping)
        off_there = residual(model, forward, there, target)
        better = ((off_there**2).sum(axis=1) < (off**2).sum(axis=1)) & (
            abs(there).max(axis=1) <= MAX_MULTIPLIER
        )
        active = abs(off).max(axis=1) > tolerance
        move = (better & active)[:, None]
        damping = jnp.where(better, damping / 4, damping * 4)
        return count + 1, jnp.where(move, there, here), damping, jnp.where(move, off_there, off)

    def unfinished(state: State) -> jax.Array:
        count, *_, off = state
        return (count < steps) & (abs(off).max() > tolerance)

    begin = (jnp.asarray(0), multipliers, damping, residual(model, forward, multipliers, target))
    _, multipliers, damping, off = jax.lax.while_loop(unfinished, damped_step, begin)
    return multipliers, damping, abs(off).max(axis=1)
