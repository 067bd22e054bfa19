"""The step of least change: of all spectra of a colour, the one nearest to the prior.

minimise |R⁻¹ (p − p₀)|² subject to r(p) = t (docs/mathematics.md, 5), for many problems at once. Rows are independent
problems, each with its own damping. The functions use the array API: lattices are solved on JAX, few problems in numpy.
`uplift.fit.least_change_solver` makes a solver of optimistix of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.models import Model
from uplift.models.matmul import matmul_rows
from uplift.models.minimum_norm import ForwardMap, least_change_step, residual
from uplift.models.roots import MAX_MULTIPLIER

FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a rejected one."""

Residual = Callable[[Any], Any]
"""From multipliers (n, C) to target minus RGB (n, 3)."""


class LeastChangeState(NamedTuple):
    """State of n problems between steps."""

    residual: Any
    """(n, 3) target minus RGB."""
    moved: Any
    """(n, C) difference from the prior, R⁻¹ (p − p₀)."""
    damping: Any
    """(n,) μ."""
    pull: Any
    """(n,) 1, or 0 once a step was rejected: a problem that hard is no longer pulled towards its prior."""

    @property
    def distance(self) -> Any:
        """(n,) max |target − RGB|."""
        return abs(self.residual).max(axis=1)


def begin(forward: ForwardMap, off: Residual, y: Any, prior: Any, damping: Any, pull: Any) -> LeastChangeState:
    """Evaluate the residuals at multipliers ``y`` (n, C)."""
    return LeastChangeState(off(y), matmul_rows(y - prior, forward.inverse_root.T), damping, pull)


def step(
    model: Model, forward: ForwardMap, off: Residual, y: Any, state: LeastChangeState, tolerance: Any
) -> tuple[Any, LeastChangeState]:
    """Take one step in every problem whose distance exceeds the tolerance.

    A step is accepted where it reduces the squared residual; no residual increases.

    References
    ----------
    Nocedal & Wright 2006, "Numerical optimization", 18.1: the step solves the linearised problem.
    """
    where = y.__array_namespace__().where
    change = least_change_step(model, forward, y, state.residual, state.damping, state.moved * state.pull[:, None])
    trial = y + matmul_rows(change, forward.root.T)
    residual = off(trial)
    better = ((residual**2).sum(axis=1) < (state.residual**2).sum(axis=1)) & (abs(trial).max(axis=1) <= MAX_MULTIPLIER)
    accept = (better & (state.distance > tolerance))[:, None]
    after = LeastChangeState(
        residual=where(accept, residual, state.residual),
        moved=where(accept, state.moved + change, state.moved),
        damping=where(better, state.damping / 4, state.damping * 4),
        pull=where(better, state.pull, 0.0),
    )
    return where(accept, trial, y), after


def nearest_of_colour(
    model: Model, forward: ForwardMap, start: Array, target: Array, tolerance: float, max_steps: int
) -> Array:
    """Solve problems one by one in numpy: for few of them, nothing needs to be compiled.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to RGB.
    start : ndarray, shape (n, C)
        Multipliers to start from; each step changes the current ones least.
    target : ndarray, shape (n, 3)
        Linear RGB.
    tolerance : float
        Distance at which a problem is solved.
    max_steps : int
        Limit of the number of steps.

    Returns
    -------
    ndarray, shape (n, C)
        Multipliers.
    """
    found = start.copy()
    damping, no_pull = np.full(1, FIRST_DAMPING), np.zeros(1)
    for row, goal in enumerate(target):
        y = start[row : row + 1]

        def off(p: Array, goal: Array = goal) -> Array:
            return np.asarray(residual(model, forward, p, goal))

        state = begin(forward, off, y, y, damping, no_pull)
        for _ in range(max_steps):
            if state.distance[0] <= tolerance:
                break
            y, state = step(model, forward, off, y, state, tolerance)
        found[row] = y[0]
    return found
