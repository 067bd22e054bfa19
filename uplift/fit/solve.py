"""Solve many small least-squares problems: multipliers whose spectra have given colours (docs/mathematics.md, 5).

Problems are solved in batches of fixed shapes, a few steps of `LeastChange` per pass. Converged problems leave the
batch.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.fit.batch import batches, replicate, shard
from uplift.fit.least_change import FIRST_DAMPING, LeastChange
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, residual

STEPS, MORE_STEPS = 1, 8
"""Steps per pass. Of many problems most converge within one; with few, the overhead of a pass dominates."""
FEW = 1024
"""Number of problems up to which a pass takes `MORE_STEPS`."""
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
    steps: NDArray[np.int64]
    """(n,) steps taken."""

    @property
    def distance(self) -> Array:
        """(n,) max |target − RGB|."""
        return np.asarray(np.abs(self.residual).max(axis=1))


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
    found = Solution(start.copy(), np.full((count, 3), np.inf), np.zeros(count, dtype=np.int64))
    rows, stale = np.arange(count), np.zeros(count, dtype=np.int64)
    anchor, pull = (start, np.zeros(count)) if prior is None else (prior, np.ones(count))
    given = _Given(start, anchor, np.full(count, FIRST_DAMPING), pull, target)
    with jax.enable_x64(True):
        solver = replicate(LeastChange(model, forward, tolerance))
        for _ in range(max_passes):
            before = np.abs(found.residual[rows]).max(axis=1)
            after = _pass(solver, given)
            found.multipliers[rows], found.residual[rows] = after.multipliers, after.residual
            found.steps[rows] += after.steps
            distance = np.abs(after.residual).max(axis=1)
            stale = np.where(distance > (1 - MIN_GAIN) * before, stale + 1, 0)
            kept = (distance > tolerance) & (stale < PATIENCE)
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
    damping: Any
    pull: Any
    steps: Any


def _pass(solver: LeastChange, given: _Given) -> _After:
    """Take some steps in every problem, batch by batch."""
    count, columns = given.multipliers.shape
    after = _After(
        np.empty((count, columns)),
        np.empty((count, 3)),
        np.empty(count),
        np.empty(count),
        np.empty(count, dtype=np.int64),
    )
    steps = MORE_STEPS if count <= FEW else STEPS
    for rows, width in batches(count, MAX_SMALL_BATCHES):
        result = _advance(solver, _Given(*(shard(array[rows], width) for array in given)), steps)
        for array, part in zip(after, result, strict=True):
            array[rows] = np.asarray(part)[: rows.stop - rows.start]
    return after


@jax.jit
def _advance(solver: LeastChange, given: _Given, steps: int) -> _After:
    """Take up to ``steps`` steps in a batch."""
    options = {"prior": given.prior, "damping": given.damping, "pull": given.pull}
    tags: frozenset[object] = frozenset()

    def off(y: jax.Array, args: jax.Array) -> tuple[jax.Array, None]:
        return residual(solver.model, solver.forward, y, args), None

    def step(carry: Any) -> Any:
        count, taken, y, state = carry
        taken = taken + ~solver.solved(state)
        y, state, _ = solver.step(off, y, given.target, options, state, tags)
        return count + 1, taken, y, state

    def unfinished(carry: Any) -> jax.Array:
        count, _, y, state = carry
        return (count < steps) & ~solver.terminate(off, y, given.target, options, state, tags)[0]

    state = solver.init(off, given.multipliers, given.target, options, None, None, tags)
    taken = jnp.zeros(len(given.multipliers), dtype=jnp.int64)
    begin = (jnp.asarray(0), taken, given.multipliers, state)
    _, taken, y, state = jax.lax.while_loop(unfinished, step, begin)
    return _After(y, state.residual, state.damping, state.pull, taken)
