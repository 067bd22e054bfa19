"""Solvers of optimistix in place of the default: each row of a batch is a separate
problem.

The problem is one of least squares: the residuals of the colour, and the difference
from the prior with the small weight `CLOSENESS`, which selects the spectrum of the
colour that is nearest to the prior.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import repeat
from typing import Any, NamedTuple, TypeAlias

import equinox
import jax
import jax.numpy as jnp
import lineax
import numpy as np
import optimistix

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import format_value
from uplift.fit.solver import NO_TAGS, BatchSolver, Options, Stepped
from uplift.models.minimum_norm import ForwardMap

CLOSENESS = 1e-5
"""Weight of the difference from the prior, in linear RGB per unit of the metric; every
further pass divides it by 100.
"""
SMALL_STEP = 1e-2
"""Change at which a stock solver stops, relative to the residual requested."""
MAX_STEPS = 64
"""Steps of a pass."""
MAX_PASSES = 4
"""Passes of an unsolved problem; each but the first has the answer of the one before as
prior.
"""

Solver: TypeAlias = optimistix.AbstractLeastSquaresSolver | optimistix.AbstractMinimiser
STOCK = {
    "dogleg": optimistix.Dogleg,
    "levenberg-marquardt": optimistix.LevenbergMarquardt,
    "gauss-newton": optimistix.GaussNewton,
}
"""Classes of stock solvers by name."""


@dataclass(frozen=True, eq=False)
class RowByRow:
    """A `uplift.fit.solver.Method`: any solver of optimistix, for each row."""

    solver: Solver

    def __call__(self, forward: ForwardMap, tolerance: Any) -> "EachRow":
        """Make the solver of a batch."""
        return EachRow(self.solver, forward)

    def options(self, start: Array, prior: Array | None) -> Options:
        """Stay close to the prior, or without one to the start."""
        return {
            "prior": start if prior is None else prior,
            "closeness": np.full(len(start), CLOSENESS),
        }

    def schedule(self) -> Iterator[int]:
        """Yield the steps of each pass: solvers start again in each."""
        return repeat(MAX_STEPS, MAX_PASSES)


def as_method(solver: Any, tolerance: float) -> RowByRow:
    """Return the method of a solver, or of the name of one, that stops at a residual in
    linear RGB. Raise `OptionError` for anything else.
    """
    if isinstance(solver, Solver):
        return RowByRow(solver)
    if isinstance(solver, str) and solver in STOCK:
        return stock_solver(solver, tolerance)
    raise OptionError(
        f"solver must be a name or a solver of optimistix, got {format_value(solver)}"
    )


@cache
def stock_solver(name: str, tolerance: float) -> RowByRow:
    """Return a stock solver that stops at a residual in linear RGB."""
    small = tolerance * SMALL_STEP
    return RowByRow(
        STOCK[name](
            rtol=small, atol=small, linear_solver=lineax.Normal(lineax.Cholesky())
        )
    )


class EachRowState(NamedTuple):
    """State of n problems between steps."""

    inner: Any
    """States of the solver, with a first axis of rows."""
    residual: Any
    """(n, 3) target minus RGB, t − r."""
    done: Any
    """(n,) whether the solver has terminated."""


class EachRow(BatchSolver):
    """Another solver for every row of a batch, in the coordinates x = R⁻¹ p of the
    metric.
    """

    solver: Solver
    forward: ForwardMap
    rtol: float = 0.0
    atol: float = 0.0

    def init(
        self, fn: Any, y: Any, args: Any, options: Options, *rest: Any
    ) -> EachRowState:
        """Start the solver in every row, at multipliers ``y`` (n, C)."""

        def begin(x: Any, row: Any) -> Any:
            problem = self._problem(fn)
            return self.solver.init(
                problem, x, row, {}, *jax.eval_shape(problem, x, row), NO_TAGS
            )

        x, rows = self._rows(y, args, options)
        inner = equinox.filter_vmap(begin)(x, rows)
        return EachRowState(inner, fn(y, args)[0], jnp.zeros(len(y), dtype=bool))

    def step(
        self,
        fn: Any,
        y: Any,
        args: Any,
        options: Options,
        state: EachRowState,
        *rest: Any,
    ) -> Stepped:
        """Take a step in every row that has not terminated."""

        def advance(x: Any, row: Any, inner: Any, done: Any) -> Any:
            problem = self._problem(fn)
            after, new, _ = self.solver.step(problem, x, row, {}, inner, NO_TAGS)
            ended, result = self.solver.terminate(problem, after, row, {}, new, NO_TAGS)
            arrays, static = equinox.partition((after, new), equinox.is_array)
            before, _ = equinox.partition((x, inner), equinox.is_array)
            kept = jax.tree.map(
                lambda old, now: jnp.where(done, old, now), before, arrays
            )
            ended = (
                ended
                | (result != optimistix.RESULTS.successful)
                | ~jnp.isfinite(after).all()
            )
            return *equinox.combine(kept, static), done | ended

        x, rows = self._rows(y, args, options)
        x, inner, done = equinox.filter_vmap(advance)(x, rows, state.inner, state.done)
        y = x @ self.forward.root.T
        residual, aux = fn(y, args)
        return (
            y,
            EachRowState(
                inner, jnp.where(jnp.isfinite(residual), residual, jnp.inf), done
            ),
            aux,
        )

    def done(self, state: EachRowState) -> Any:
        return state.done

    def resume(self, options: Options, y: Any, state: EachRowState) -> Options:
        """Go on closer to the colour: the first answers are near the prior, later ones
        near the last answer.
        """
        return {"prior": y, "closeness": options["closeness"] / 100}

    def _rows(self, y: Any, args: Any, options: Options) -> tuple[Any, Any]:
        """Coordinates (n, C) of multipliers, and what the problem of each
        row is given.
        """
        x, prior = (
            multipliers @ self.forward.inverse_root.T
            for multipliers in (y, options["prior"])
        )
        return x, (prior, options["closeness"], args)

    def _problem(self, fn: Any) -> Callable[[Any, Any], tuple[Any, None]]:
        """Make the function of a row: t − r(R x), and ε (x − x₀)."""

        def residuals(x: Any, row: Any) -> tuple[Any, None]:
            prior, closeness, args = row
            colour, _ = fn((self.forward.root @ x)[None], args)
            return (colour[0], closeness * (x - prior)), None

        return _objective(self.solver, residuals)


def _objective(solver: Solver, residuals: Any) -> Any:
    """What a solver minimises: the sum of squares of residuals, or half of it as a
    number for a minimiser.
    """
    if isinstance(solver, optimistix.AbstractLeastSquaresSolver):
        return residuals

    def half_squares(y: Any, args: Any) -> tuple[Any, None]:
        values, aux = residuals(y, args)
        return sum((residual**2).sum() for residual in jax.tree.leaves(values)) / 2, aux

    return half_squares
