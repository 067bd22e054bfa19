"""Solve many small least-squares problems: multipliers whose spectra have given colours (docs/mathematics.md, 5).

Problems are solved in batches of fixed shapes, one or a few steps of least change per pass. Converged problems leave
the batch. The steps of a problem do not depend on the others.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.fit.batch import batches, replicate, shard
from uplift.fit.least_change import FIRST_DAMPING, begin, step
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, residual

SINGLE_STEPS, MORE_STEPS = 2, 8
"""Passes that take one step, in which most problems converge, and the steps of each later pass."""
MAX_SMALL_BATCHES = 12
"""Small batches that are cheaper than a large one, which runs until its last problem converges."""
MIN_GAIN, PATIENCE = 1e-3, 8
"""A problem is abandoned after `PATIENCE` consecutive passes that each reduce its distance by less than `MIN_GAIN`.

Otherwise unrealisable points, frequent in wide gamuts, would remain until the last pass.
"""


class Solution(NamedTuple):
    """Result of `solve`."""

    multipliers: Array
    """(n, C) multipliers."""
    residual: Array
    """(n, 3) target minus RGB."""
    distance: Array
    """(n,) max |target − RGB|."""
    steps: NDArray[np.int64]
    """(n,) steps taken."""


def solve(
    model: Model,
    forward: ForwardMap,
    start: Array,
    target: Array,
    *,
    tolerance: float,
    max_passes: int,
    prior: Array | None = None,
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
    prior : ndarray, shape (n, C), optional
        Multipliers to change least. By default each step changes the current ones least, which is more robust far
        from the answer.

    Returns
    -------
    Solution
        Multipliers, residuals and numbers of steps.
    """
    count = len(start)
    found = Solution(start.copy(), np.empty((count, 3)), np.full(count, np.inf), np.zeros(count, dtype=np.int64))
    rows, stale = np.arange(count), np.zeros(count, dtype=np.int64)
    anchor, pull = (start, np.zeros(count)) if prior is None else (prior, np.ones(count))
    given = _Given(start, anchor, np.full(count, FIRST_DAMPING), pull, target)
    with jax.enable_x64(True):
        constants = replicate(forward)
        for number in range(max_passes if count else 0):
            steps = 1 if number < SINGLE_STEPS else MORE_STEPS
            after = _pass(model, constants, tolerance, given, steps)
            before = found.distance[rows]
            found.multipliers[rows], found.residual[rows] = after.multipliers, after.residual
            found.distance[rows] = after.distance
            found.steps[rows] += after.steps
            stale = np.where(after.distance > (1 - MIN_GAIN) * before, stale + 1, 0)
            kept = (after.distance > tolerance) & (stale < PATIENCE)
            if not kept.any():
                break
            rows, stale = rows[kept], stale[kept]
            unsolved = (after.multipliers, given.prior, after.damping, after.pull, given.target)
            given = _Given(*(array[kept] for array in unsolved))
    return found


class _Given(NamedTuple):
    """State of k problems before a pass."""

    multipliers: Array
    prior: Array
    damping: Array
    pull: Array
    target: Array


class _After(NamedTuple):
    """State of k problems after a pass."""

    multipliers: Any
    residual: Any
    distance: Any
    damping: Any
    pull: Any
    steps: Any


def _pass(model: Model, forward: ForwardMap, tolerance: float, given: _Given, steps: int) -> _After:
    """Take up to ``steps`` steps in every problem, batch by batch."""
    count, columns = given.multipliers.shape
    after = _After(
        multipliers=np.empty((count, columns)),
        residual=np.empty((count, 3)),
        distance=np.empty(count),
        damping=np.empty(count),
        pull=np.empty(count),
        steps=np.empty(count, dtype=np.int64),
    )
    for rows, width in batches(count, MAX_SMALL_BATCHES):
        part = _Given(*(shard(array[rows], width) for array in given))
        result = _advance(model, forward, tolerance, part, steps)
        for array, found in zip(after, result, strict=True):
            array[rows] = np.asarray(found)[: rows.stop - rows.start]
    return after


@partial(jax.jit, static_argnums=0)
def _advance(model: Model, forward: ForwardMap, tolerance: float, given: _Given, max_steps: int) -> _After:
    """Take up to ``max_steps`` steps in a batch."""

    def off(y: jax.Array) -> Any:
        return residual(model, forward, y, given.target)

    def advance(carry: Any) -> Any:
        count, taken, y, state = carry
        taken = taken + (state.distance > tolerance)
        return count + 1, taken, *step(model, forward, off, y, state, tolerance)

    def unfinished(carry: Any) -> jax.Array:
        count, _, _, state = carry
        return (count < max_steps) & (state.distance > tolerance).any()

    state = begin(forward, off, given.multipliers, given.prior, given.damping, given.pull)
    taken = jnp.zeros(len(given.multipliers), dtype=jnp.int64)
    _, taken, y, state = jax.lax.while_loop(unfinished, advance, (jnp.asarray(0), taken, given.multipliers, state))
    return _After(y, state.residual, state.distance, state.damping, state.pull, taken)
