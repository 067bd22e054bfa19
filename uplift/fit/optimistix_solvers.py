"""Solvers of optimistix: that of the fit as one of them, and any other in its place, problem by problem under ``vmap``.

For other solvers the problem is one of least squares: the residuals of the colour, and the difference from the prior
with the small weight `CLOSENESS`. It has one minimum near the prior, which all solvers find.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import equinox
import jax
import jax.numpy as jnp
import lineax
import numpy as np
import optimistix

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.fit.batch import map_batches
from uplift.fit.solver import FIRST_DAMPING, Solution, SolverState, init_state, take_step
from uplift.models.minimum_norm import ForwardMap

if TYPE_CHECKING:
    from uplift.fit.entries import Objective

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
STOCK = {
    "dogleg": optimistix.Dogleg,
    "levenberg-marquardt": optimistix.LevenbergMarquardt,
    "gauss-newton": optimistix.GaussNewton,
}
"""Classes of stock solvers by name."""


def stock_solver(name: str, tolerance: float) -> Solver:
    """Return a stock solver that stops at a residual in linear RGB."""
    small = tolerance * SMALL_STEP
    return STOCK[name](rtol=small, atol=small, linear_solver=lineax.Normal(lineax.Cholesky()))


class LeastChange(optimistix.AbstractLeastSquaresSolver):  # type: ignore[misc]
    """The steps of `uplift.fit.solver` for a batch of problems with three residuals each.

    ``atol`` is the residual in linear RGB at which a problem is solved. The options of `init` are ``prior`` (n, C), the
    multipliers to change least (``y`` by default), and ``damping`` and ``anchor_weight`` (n,) of an earlier state.
    """

    forward: ForwardMap
    atol: float
    rtol: float = 0.0
    norm: Callable[[Any], Any] = equinox.field(static=True, default=optimistix.max_norm)

    def init(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], f_struct: Any, aux_struct: Any, tags: Any
    ) -> SolverState:
        """Evaluate the residuals at ``y`` (n, C)."""
        ones = jnp.ones(len(y))
        given = {"prior": y, "damping": FIRST_DAMPING * ones, "anchor_weight": ones, **options}
        return init_state(self.forward, lambda p: fn(p, args)[0], y, **given)

    def step(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: SolverState, tags: Any
    ) -> tuple[Any, SolverState, Any]:
        """Take one step in every problem that is not solved."""
        y, state = take_step(self.forward, lambda p: fn(p, args)[0], y, state, self.atol)
        return y, state, fn(y, args)[1]

    def terminate(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: SolverState, tags: Any
    ) -> tuple[jax.Array, Any]:
        """Whether all problems are solved."""
        return (state.distance <= self.atol).all(), optimistix.RESULTS.successful

    def postprocess(self, fn: Any, y: Any, aux: Any, *rest: Any) -> tuple[Any, Any, dict[str, Any]]:
        """Return the solution as it is."""
        return y, aux, {}


def solve_with(
    solver: Solver,
    forward: ForwardMap,
    start: Array,
    target: Array,
    *,
    tolerance: float,
    max_passes: int,
    prior: Array | None = None,
) -> Solution:
    """Do the same as `uplift.fit.solver.solve` by a solver of optimistix."""
    count = len(start)
    solution = Solution(start.copy(), np.empty((count, 3)), np.full(count, np.inf))
    rows, prior = np.arange(count), start if prior is None else prior
    for number in range(min(max_passes, MAX_ROUNDS)):
        if not rows.size:
            break
        # ε of the round: the first answers are near the prior, those of later rounds near the colour.
        constants = (forward, np.array(CLOSENESS / 100**number))
        given = (solution.multipliers[rows], prior, target[rows])
        multipliers, residual = map_batches(partial(_solve, solver), constants, *given)
        distance = np.abs(residual).max(axis=1)
        closer = distance < solution.distance[rows]
        for array, values in zip(solution, (multipliers, residual, distance), strict=True):
            array[rows[closer]] = values[closer]
        rows = rows[solution.distance[rows] > tolerance]
        prior = solution.multipliers[rows]
    return solution


@equinox.filter_jit  # type: ignore[untyped-decorator]
def _solve(
    solver: Solver, constants: tuple[ForwardMap, jax.Array], start: jax.Array, prior: jax.Array, target: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Multipliers and residuals of a batch."""
    forward, closeness = constants

    def residuals(y: jax.Array, args: Any) -> tuple[jax.Array, jax.Array]:
        # t − r(R y), and ε (y − y₀), with y = R⁻¹ p
        expected, rgb = args
        return forward.residual((forward.root @ y)[None], rgb)[0], closeness * (y - expected)

    def solve_one(y: jax.Array, *args: jax.Array) -> Any:
        return optimistix.least_squares(residuals, solver, y, args=args, max_steps=MAX_STEPS, throw=False).value

    y, expected = (array @ forward.inverse_root.T for array in (start, prior))
    multipliers = jax.vmap(solve_one)(y, expected, target) @ forward.root.T
    residual = forward.residual(multipliers, target)
    return multipliers, jnp.where(jnp.isfinite(residual), residual, jnp.inf)


def minimise(solver: Solver, goal: Objective, measured: Array) -> Array:
    """Multipliers (E, C) that minimise the objective of measured reflectances (E, N), starting from grey.

    Raises `UpliftError` if the solver does not find a minimum.
    """
    multipliers = np.zeros((0, goal.model.count))
    if len(measured):
        multipliers = map_batches(lambda _, rows: _minimise(solver, goal, rows), (), measured, max_small=len(measured))
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
    def residuals(multipliers: jax.Array, spectrum: jax.Array) -> jax.Array:
        return goal.residuals(multipliers, spectrum, goal.colours(spectrum))

    def solve_one(spectrum: jax.Array) -> Any:
        start = jnp.zeros(goal.model.count)
        return optimistix.least_squares(
            residuals, solver, start, args=spectrum, max_steps=MAX_ENTRY_STEPS, throw=False
        ).value

    return jax.vmap(solve_one)(measured)
