"""The solver of the fit: of all spectra of a colour, the one nearest to the prior (docs/mathematics.md, 5).

minimise |R⁻¹ (p − p₀)|² subject to r(p) = t, by damped steps (Nocedal & Wright 2006, "Numerical optimization", 18.1).
Rows are independent problems, each with its own damping. The step uses the array API: nodes are solved on JAX in
batches of fixed shapes, entries one by one in numpy, where nothing needs to be compiled.
`uplift.fit.optimistix_solvers` makes a solver of optimistix of it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.fit.batch import batches, replicate, shard
from uplift.models import Model
from uplift.models.arithmetic import matmul_rows
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.minimum_norm import ForwardMap, anchored_step, residual

FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a rejected one."""
SINGLE_STEPS, MORE_STEPS = 2, 8
"""Passes that take one step, in which most problems converge, and the steps of each later pass."""
MAX_SMALL_BATCHES = 12
"""Small batches that are cheaper than a large one, which runs until its last problem converges."""
MIN_GAIN, PATIENCE = 1e-3, 8
"""A problem is abandoned after `PATIENCE` consecutive passes that each reduce its distance by less than `MIN_GAIN`.
Otherwise unrealisable colours, frequent in wide gamuts, would remain until the last pass."""


class SolverState(NamedTuple):
    """State of n problems between steps."""

    residual: Any
    """(n, 3) target minus RGB, t − r."""
    displacement: Any
    """(n, C) difference from the prior, d = R⁻¹ (p − p₀)."""
    damping: Any
    """(n,) μ."""
    anchor_weight: Any
    """(n,) 1, or 0 once a step was rejected: a problem that hard is no longer pulled towards its prior."""

    @property
    def distance(self) -> Any:
        """(n,) max |target − RGB|."""
        return abs(self.residual).max(axis=1)


def init_state(
    forward: ForwardMap, residual_of: Callable[[Any], Any], y: Any, prior: Any, damping: Any, anchor_weight: Any
) -> SolverState:
    """Evaluate the residuals at multipliers ``y`` (n, C)."""
    return SolverState(residual_of(y), matmul_rows(y - prior, forward.inverse_root.T), damping, anchor_weight)


def take_step(
    model: Model, forward: ForwardMap, residual_of: Callable[[Any], Any], y: Any, state: SolverState, tolerance: Any
) -> tuple[Any, SolverState]:
    """Take one step in every problem whose distance exceeds the tolerance; no squared residual increases."""
    where = y.__array_namespace__().where
    # Δx = A⁺ (t − r + A d) − d, and p changes by R Δx.
    anchored = state.displacement * state.anchor_weight[:, None]
    change = anchored_step(model, forward, y, state.residual, state.damping, anchored)
    trial = y + matmul_rows(change, forward.root.T)
    left = residual_of(trial)
    # A step is accepted where it reduces the squared residual; μ follows the success of the linearisation.
    better = ((left**2).sum(axis=1) < (state.residual**2).sum(axis=1)) & (abs(trial).max(axis=1) <= MAX_MULTIPLIER)
    accept = (better & (state.distance > tolerance))[:, None]
    after = SolverState(
        residual=where(accept, left, state.residual),
        displacement=where(accept, state.displacement + change, state.displacement),
        damping=where(better, state.damping / 4, state.damping * 4),
        anchor_weight=where(better, state.anchor_weight, 0.0),
    )
    return where(accept, trial, y), after


def solve_singly(
    model: Model, forward: ForwardMap, start: Array, target: Array, tolerance: float, max_steps: int
) -> Array:
    """Find multipliers (n, C) of linear RGB (n, 3), one problem after another, each nearest to its own start."""
    multipliers = start.copy()
    damping, free = np.full(1, FIRST_DAMPING), np.zeros(1)
    for row, goal in enumerate(target):
        y = start[row : row + 1]
        residual_of = partial(residual, model, forward, target=goal)
        state = init_state(forward, residual_of, y, y, damping, free)
        for _ in range(max_steps):
            if state.distance[0] <= tolerance:
                break
            y, state = take_step(model, forward, residual_of, y, state, tolerance)
        multipliers[row] = y[0]
    return multipliers


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
    """Find multipliers of linear RGB ``target`` (n, 3), from ``start`` (n, C), nearest to ``prior`` (n, C).

    Without a prior each step changes the current multipliers least, which is more robust far from the answer. No
    distance increases. Failure to converge is not an error: the distance reports it. The steps of a problem do not
    depend on the others.
    """
    count = len(start)
    solution = Solution(start.copy(), np.empty((count, 3)), np.full(count, np.inf), np.zeros(count, dtype=np.int64))
    rows, stale = np.arange(count), np.zeros(count, dtype=np.int64)
    anchor, anchor_weight = (start, np.zeros(count)) if prior is None else (prior, np.ones(count))
    given = _Given(start, anchor, np.full(count, FIRST_DAMPING), anchor_weight, target)
    with jax.enable_x64(True):
        constants = replicate(forward)
        # One step at a time while most problems converge, then several, to pass through fewer batches.
        for number in range(max_passes if count else 0):
            steps = 1 if number < SINGLE_STEPS else MORE_STEPS
            parts = []
            for batch, width in batches(len(rows), MAX_SMALL_BATCHES):
                part = _Given(*(shard(array[batch], width) for array in given))
                arrays = _advance(model, constants, tolerance, part, steps)
                parts.append([np.asarray(array)[: batch.stop - batch.start] for array in arrays])
            after = _After(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))
            before = solution.distance[rows]
            solution.multipliers[rows], solution.residual[rows] = after.multipliers, after.residual
            solution.distance[rows] = after.distance
            solution.steps[rows] += after.steps
            # Converged and abandoned problems leave the batch.
            stale = np.where(after.distance > (1 - MIN_GAIN) * before, stale + 1, 0)
            kept = (after.distance > tolerance) & (stale < PATIENCE)
            if not kept.any():
                break
            rows, stale = rows[kept], stale[kept]
            unsolved = (after.multipliers, given.prior, after.damping, after.anchor_weight, given.target)
            given = _Given(*(array[kept] for array in unsolved))
    return solution


class _Given(NamedTuple):
    """State of k problems before a pass."""

    multipliers: Any
    prior: Any
    damping: Any
    anchor_weight: Any
    target: Any


class _After(NamedTuple):
    """State of k problems after a pass."""

    multipliers: Any
    residual: Any
    distance: Any
    damping: Any
    anchor_weight: Any
    steps: Any


@partial(jax.jit, static_argnums=0)
def _advance(model: Model, forward: ForwardMap, tolerance: float, given: _Given, max_steps: int) -> _After:
    """Take up to ``max_steps`` steps in a batch."""
    residual_of = partial(residual, model, forward, target=given.target)

    def advance(carry: Any) -> Any:
        count, taken, y, state = carry
        taken = taken + (state.distance > tolerance)
        return count + 1, taken, *take_step(model, forward, residual_of, y, state, tolerance)

    def unfinished(carry: Any) -> jax.Array:
        count, _, _, state = carry
        return (count < max_steps) & (state.distance > tolerance).any()

    state = init_state(forward, residual_of, given.multipliers, given.prior, given.damping, given.anchor_weight)
    taken = jnp.zeros(len(given.multipliers), dtype=jnp.int64)
    _, taken, y, state = jax.lax.while_loop(unfinished, advance, (jnp.asarray(0), taken, given.multipliers, state))
    return _After(y, state.residual, state.distance, state.damping, state.anchor_weight, taken)
