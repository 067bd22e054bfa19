"""Solvers of optimistix for the problems of the fit: each problem alone, many at once by ``vmap``.

The problem is that of the step of least change, as least squares: the residuals of the colour, and the difference from
the prior with the small weight `CLOSENESS`. It has one minimum near the prior, which all solvers find.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import equinox
import jax
import jax.numpy as jnp
import lineax
import numpy as np
import optimistix

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.fit.batch import batches, replicate, shard
from uplift.fit.objective import Objective
from uplift.fit.solve import Solution
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, residual

CLOSENESS = 1e-5
"""Weight of the difference from the prior, in linear RGB per unit of the metric; a hundredth of it in each further
round."""
SMALL_STEP = 1e-2
"""Change at which a stock solver stops, relative to the residual requested."""
MAX_STEPS = 64
"""Steps of a round for a problem of the lattice."""
MAX_ENTRY_STEPS = 256
MAX_STEEPNESS = 1e-5
"""`Objective.steepness` of a minimum; MINPACK ends below 2e-6, stock solvers below 1e-7."""
MAX_ROUNDS = 4
"""Times that an unsolved problem is solved again, with its last answer as prior."""

SOLVER_TYPES = (optimistix.AbstractLeastSquaresSolver, optimistix.AbstractMinimiser)
Solver: TypeAlias = "optimistix.AbstractLeastSquaresSolver | optimistix.AbstractMinimiser"


def _with_cholesky(kind: Any) -> Callable[[float], Any]:
    linear_solver = lineax.Normal(lineax.Cholesky())
    return lambda tolerance: kind(rtol=tolerance * SMALL_STEP, atol=tolerance * SMALL_STEP, linear_solver=linear_solver)


STOCK: dict[str, Callable[[float], Any]] = {
    "dogleg": _with_cholesky(optimistix.Dogleg),
    "levenberg-marquardt": _with_cholesky(optimistix.LevenbergMarquardt),
    "gauss-newton": _with_cholesky(optimistix.GaussNewton),
}
"""Stock solvers by name: from the tolerance to the solver."""


@dataclass(frozen=True, eq=False)
class StockSolver:
    """A solver of optimistix in the place of `uplift.fit.solve.solve`.

    Parameters
    ----------
    solver : optimistix.AbstractLeastSquaresSolver or optimistix.AbstractMinimiser
        Any solver of least squares.
    """

    solver: Solver

    def __call__(
        self,
        model: Model,
        forward: ForwardMap,
        start: Array,
        target: Array,
        *,
        tolerance: float,
        max_passes: int,
        prior: Array | None = None,
    ) -> Solution:
        """Solve for multipliers that have given colours; see `uplift.fit.solve.solve`."""
        count = len(start)
        found = Solution(start.copy(), np.empty((count, 3)), np.full(count, np.inf), np.zeros(count, dtype=np.int64))
        rows, prior = np.arange(count), start if prior is None else prior
        with jax.enable_x64(True):
            map_ = replicate(forward)
            for number in range(min(max_passes, MAX_ROUNDS)):
                closeness = jnp.asarray(CLOSENESS / 100**number)
                for part, width in batches(len(rows)):
                    own = rows[part]
                    given = (found.multipliers[own], prior[part], target[own])
                    result = _solve(self.solver, model, map_, closeness, *(shard(array, width) for array in given))
                    multipliers, off, steps = (np.asarray(array)[: len(own)] for array in result)
                    distance = np.abs(off).max(axis=1)
                    closer = distance < found.distance[own]
                    for array, new in zip(found, (multipliers, off, distance), strict=False):
                        array[own[closer]] = new[closer]
                    found.steps[own] += steps
                rows = rows[found.distance[rows] > tolerance]
                prior = found.multipliers[rows]
                if not rows.size:
                    break
        return found


def solve_objective(solver: Solver, goal: Objective, measured: Array) -> Array:
    """Multipliers (E, C) that minimise the objective of measured reflectances (E, N), starting from grey.

    Raises
    ------
    UpliftError
        The solver does not find a minimum (``solver-failed``).
    """
    multipliers = np.zeros((len(measured), goal.model.count))
    with jax.enable_x64(True):
        for rows, width in batches(len(measured), max_small=len(measured)):
            part = multipliers[rows]
            part[:] = np.asarray(_minimise(solver, goal, shard(measured[rows], width)))[: len(part)]
    pairs = zip(multipliers, measured, strict=True)
    failed = sum(not goal.steepness(p, spectrum) <= MAX_STEEPNESS for p, spectrum in pairs)
    if failed:
        raise UpliftError(
            f"{type(solver).__name__} does not converge at {failed} of {len(measured)} atlas entries",
            code="solver-failed",
            hint="use another solver, such as the default",
        )
    return multipliers


@equinox.filter_jit  # type: ignore[untyped-decorator]
def _minimise(solver: Solver, goal: Objective, measured: jax.Array) -> jax.Array:
    start = jnp.zeros(goal.model.count)

    def one(spectrum: jax.Array) -> jax.Array:
        return optimistix.least_squares(
            goal.residuals, solver, start, args=spectrum, max_steps=MAX_ENTRY_STEPS, throw=False
        ).value

    return jax.vmap(one)(measured)


@equinox.filter_jit  # type: ignore[untyped-decorator]
def _solve(
    solver: Solver,
    model: Model,
    forward: ForwardMap,
    closeness: jax.Array,
    start: jax.Array,
    prior: jax.Array,
    target: jax.Array,
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Multipliers, residuals and numbers of steps of a batch."""

    def off(y: jax.Array, args: Any) -> tuple[jax.Array, jax.Array]:
        expected, rgb, weight = args
        colour = residual(model, forward, (forward.root @ y)[None], rgb[None])[0]
        return colour, weight * (y - expected)

    def one(y: jax.Array, expected: jax.Array, rgb: jax.Array) -> tuple[jax.Array, jax.Array]:
        solution = optimistix.least_squares(
            off, solver, y, args=(expected, rgb, closeness), max_steps=MAX_STEPS, throw=False
        )
        return solution.value, solution.stats["num_steps"]

    y, expected = (array @ forward.inverse_root.T for array in (start, prior))
    y, steps = jax.vmap(one)(y, expected, target)
    multipliers = y @ forward.root.T
    colour = residual(model, forward, multipliers, target)
    return multipliers, jnp.where(jnp.isfinite(colour), colour, jnp.inf), steps
