"""Solve many small least-squares problems: multipliers whose spectra have given colours (docs/mathematics.md, 5).

Problems are solved in batches of fixed shapes, a few damped steps per pass. Converged problems leave the batch.
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
"""Damped steps per pass. Of many problems most converge within two; with few, the overhead of a pass dominates."""
FEW = 1024
"""Number of problems up to which a pass takes `MORE_STEPS`."""
MAX_SMALL_BATCHES = 12
"""Small batches that are cheaper than a large one, which runs until its last problem converges."""
FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a rejected one."""
MIN_GAIN, PATIENCE = 1e-3, 8
"""A problem is abandoned after `PATIENCE` consecutive passes that each reduce its distance by less than `MIN_GAIN`.

Otherwise unrealisable points, frequent in wide gamuts, would remain until the last pass.
"""

State = tuple[jax.Array, jax.Array, jax.Array, jax.Array]
"""Step count, multipliers, damping, residual."""


class Solution(NamedTuple):
    """Result of `solve`."""

    multipliers: Array
    """(n, C) multipliers."""
    distance: Array
    """(n,) max |target − RGB|."""


def solve(
    model: Model, forward: ForwardMap, start: Array, target: Array, *, tolerance: float, max_passes: int
) -> Solution:
    """Solve for multipliers that have given colours.

    No distance increases. Failure to converge is not an error: the distance reports it.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to RGB.
    start : ndarray, shape (n, C)
        Multipliers to start from.
    target : ndarray, shape (n, 3)
        Linear RGB.
    tolerance : float
        Distance at which a problem is solved.
    max_passes : int
        Limit of the number of passes.

    Returns
    -------
    Solution
        Multipliers and their distances.
    """
    multipliers, damping = start.copy(), np.full(len(start), FIRST_DAMPING)
    distance = np.full(len(start), np.inf)
    stale = np.zeros(len(start), dtype=np.int64)
    pending = np.arange(len(start))
    with jax.enable_x64(True):
        constants = replicate(forward)
        for _ in range(max_passes):
            before = distance[pending]
            steps = MORE_STEPS if len(pending) <= FEW else STEPS
            for rows, padded in batches(pending, MAX_SMALL_BATCHES):
                batch = (shard(array[padded]) for array in (multipliers, damping, target))
                found = _advance(model, constants, *batch, tolerance, steps)
                for array, part in zip((multipliers, damping, distance), found, strict=True):
                    array[rows] = np.asarray(part)[: len(rows)]
            stale[pending] = np.where(distance[pending] > (1 - MIN_GAIN) * before, stale[pending] + 1, 0)
            pending = pending[(distance[pending] > tolerance) & (stale[pending] < PATIENCE)]
            if not pending.size:
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
    """Take up to ``steps`` damped steps; a step is accepted where it reduces the squared distance."""

    def damped_step(state: State) -> State:
        count, current, damping, off = state
        trial = current + minimum_norm_step(model, forward, current, off, damping)
        trial_off = residual(model, forward, trial, target)
        better = ((trial_off**2).sum(axis=1) < (off**2).sum(axis=1)) & (
            abs(trial).max(axis=1) <= MAX_MULTIPLIER
        )
        active = abs(off).max(axis=1) > tolerance
        accept = (better & active)[:, None]
        damping = jnp.where(better, damping / 4, damping * 4)
        return count + 1, jnp.where(accept, trial, current), damping, jnp.where(accept, trial_off, off)

    def unfinished(state: State) -> jax.Array:
        count, *_, off = state
        return (count < steps) & (abs(off).max() > tolerance)

    begin = (jnp.asarray(0), multipliers, damping, residual(model, forward, multipliers, target))
    _, multipliers, damping, off = jax.lax.while_loop(unfinished, damped_step, begin)
    return multipliers, damping, abs(off).max(axis=1)
