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

from uplift.common.arrays import Array
from uplift.fit.batch import map_batches
from uplift.models.arithmetic import blocked_matmul
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.minimum_norm import ForwardMap, anchored_step

FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a rejected one."""
SINGLE_STEPS, MORE_STEPS = 2, 8
"""Passes that take one step, in which most problems converge, and the steps of each later pass."""
MAX_SMALL_BATCHES = 12
"""Small batches that are cheaper than a large one, which runs until its last problem converges."""
MIN_GAIN, PATIENCE = 1e-3, 8
"""A problem is abandoned after `PATIENCE` consecutive passes that each reduce its distance by less than `MIN_GAIN`.
Otherwise unrealisable colours, frequent in wide gamuts, would remain until the last pass."""

Residual = Callable[[Any], Any]
"""From multipliers (n, C) to target minus RGB, t − r, (n, 3)."""


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
    forward: ForwardMap, residual: Residual, y: Any, prior: Any, damping: Any, anchor_weight: Any
) -> SolverState:
    """Evaluate the residuals at multipliers ``y`` (n, C)."""
    return SolverState(residual(y), blocked_matmul(y - prior, forward.inverse_root.T), damping, anchor_weight)


def take_step(
    forward: ForwardMap, residual: Residual, y: Any, state: SolverState, tolerance: Any
) -> tuple[Any, SolverState]:
    """Take one step in every problem whose distance exceeds the tolerance; no squared residual increases."""
    where = y.__array_namespace__().where
    # Δx = A⁺ (t − r + A d) − d, and p changes by R Δx.
    anchored = state.displacement * state.anchor_weight[:, None]
    change = anchored_step(forward, y, state.residual, state.damping, anchored)
    trial = y + blocked_matmul(change, forward.root.T)
    left = residual(trial)
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


def solve_singly(forward: ForwardMap, start: Array, target: Array, tolerance: float, max_steps: int) -> Array:
    """Find multipliers (n, C) of linear RGB (n, 3), one problem after another, each nearest to its own start."""
    multipliers = start.copy()
    for row, goal in enumerate(target):
        y = start[row : row + 1]
        residual = partial(forward.residual, target=goal)
        state = init_state(forward, residual, y, y, np.full(1, FIRST_DAMPING), np.zeros(1))
        for _ in range(max_steps):
            if state.distance[0] <= tolerance:
                break
            y, state = take_step(forward, residual, y, state, tolerance)
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


def solve(
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
    solution = Solution(start.copy(), np.empty((count, 3)), np.full(count, np.inf))
    rows, stale = np.arange(count), np.zeros(count, dtype=np.int64)
    y, damping, anchor_weight = start, np.full(count, FIRST_DAMPING), np.full(count, float(prior is not None))
    prior = start if prior is None else prior
    # One step at a time while most problems converge, then several, to pass through fewer batches.
    for number in range(max_passes if count else 0):
        advance = partial(_advance, tolerance=tolerance, max_steps=1 if number < SINGLE_STEPS else MORE_STEPS)
        given = (y, prior[rows], target[rows], damping, anchor_weight)
        y, state = map_batches(advance, forward, *given, max_small=MAX_SMALL_BATCHES)
        before = solution.distance[rows]
        solution.multipliers[rows], solution.residual[rows], solution.distance[rows] = y, state.residual, state.distance
        # Converged and abandoned problems leave the batch.
        stale = np.where(state.distance > (1 - MIN_GAIN) * before, stale + 1, 0)
        kept = (state.distance > tolerance) & (stale < PATIENCE)
        if not kept.any():
            break
        rows, stale = rows[kept], stale[kept]
        y, damping, anchor_weight = y[kept], state.damping[kept], state.anchor_weight[kept]
    return solution


@jax.jit
def _advance(
    forward: ForwardMap,
    y: jax.Array,
    prior: jax.Array,
    target: jax.Array,
    damping: jax.Array,
    anchor_weight: jax.Array,
    *,
    tolerance: float,
    max_steps: int,
) -> tuple[jax.Array, SolverState]:
    """Take up to ``max_steps`` steps in a batch."""

    residual = partial(forward.residual, target=target)

    def advance(carry: Any) -> Any:
        count, y, state = carry
        return count + 1, *take_step(forward, residual, y, state, tolerance)

    state = init_state(forward, residual, y, prior, damping, anchor_weight)
    _, y, state = jax.lax.while_loop(
        lambda carry: (carry[0] < max_steps) & (carry[2].distance > tolerance).any(),
        advance,
        (jnp.asarray(0), y, state),
    )
    return y, state
