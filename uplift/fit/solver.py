"""The solver of the fit: of all spectra of a colour, the one nearest to the prior
(docs/mathematics.md, 5).

minimise |R⁻¹ (p − p₀)|² subject to r(p) = t, by damped steps (Nocedal & Wright 2006,
"Numerical optimization", 18.1). `LeastChange` is a solver of optimistix for many
problems at a time, each with its own damping. `solve` steps it, or any other solver of
optimistix (`uplift.extras.thesis.stock_solvers`), over batches of fixed shapes.
"""

import abc
from collections.abc import Callable, Iterator
from functools import cache, reduce
from itertools import chain, islice, repeat
from typing import Any, NamedTuple, Protocol

import equinox
import jax
import jax.numpy as jnp
import numpy as np
import optimistix
from numpy.typing import NDArray

from uplift.common.arrays import Array, blocks, largest
from uplift.common.compilation import compiled
from uplift.fit.batch import map_batches
from uplift.models.arithmetic import blocked_matmul
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.minimum_norm import ForwardMap, anchored_step

FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a
rejected one.
"""
SINGLE_STEPS = 2
"""Passes that take one step, in which most problems converge."""
MORE_STEPS = 8
"""Steps of each later pass."""
MIN_GAIN = 1e-3
"""Least relative reduction of a distance by a pass that counts as progress."""
PATIENCE = 8
"""Consecutive passes without progress after which a problem is abandoned. Otherwise
unrealisable colours, frequent in wide gamuts, would remain until the last pass.
"""
NUMPY_ROWS = 128
"""Problems of a block that is stepped in numpy."""

Options = dict[str, Any]
"""Options of a solver's ``init``: arrays with a row for each problem."""
NO_TAGS: frozenset[object] = frozenset()
"""Nothing is known of the matrices of the problem."""
Stepped = tuple[Any, Any, Any]
"""What a step of a solver returns: ``y``, its state, and what the function returned
with the residuals.
"""


class BatchSolver(optimistix.AbstractLeastSquaresSolver):  # type: ignore[misc]
    """A solver of optimistix for a batch of problems: ``y`` and the arrays of its state
    have a row for each.
    """

    norm: Callable[[Any], Any] = equinox.field(
        static=True, default=optimistix.max_norm, kw_only=True
    )

    @abc.abstractmethod
    def done(self, state: Any) -> Any:
        """Whether (n,) each problem is solved, or given up."""

    def terminate(
        self, fn: Any, y: Any, args: Any, options: Options, state: Any, *rest: Any
    ) -> tuple[Any, Any]:
        """Whether all problems are done."""
        return self.done(state).all(), optimistix.RESULTS.successful

    def postprocess(
        self, fn: Any, y: Any, aux: Any, *rest: Any
    ) -> tuple[Any, Any, dict[str, Any]]:
        """Return the solution as it is."""
        return y, aux, {}

    def resume(self, options: Options, y: Any, state: Any) -> Options:
        """Return the options that ``init`` goes on with in place of those before, from
        ``y`` (n, C) and the state.
        """
        return {}


class Method(Protocol):
    """A way to solve batches, the same object for a whole build: what is compiled for
    it is found by its identity.
    """

    def __call__(self, forward: ForwardMap, tolerance: Any) -> Any:
        """Make a solver of optimistix for a batch, which stops at a distance of
        ``tolerance`` in linear RGB.

        Its further method ``resume(options, y, state)`` returns the options with which
        ``init`` goes on.
        """

    def options(self, start: Array, prior: Array | None) -> Options:
        """Return the options of the first pass, from multipliers (n, C)."""

    def schedule(self) -> Iterator[int]:
        """Yield the steps of each pass."""


class LeastChangeState(NamedTuple):
    """State of n problems between steps."""

    residual: Any
    """(n, 3) target minus RGB, t − r."""
    displacement: Any
    """(n, C) difference from the prior, d = R⁻¹ (p − p₀)."""
    damping: Any
    """(n,) μ."""
    anchor_weight: Any
    """(n,) 1, or 0 once a step was rejected: a problem that hard is no longer pulled
    towards its prior.
    """


class LeastChange(BatchSolver):
    """Damped steps that reach the colour and change the prior least, for a batch of
    problems with three residuals each.

    ``atol`` is the distance in linear RGB at which a problem is solved. The options of
    `init` are ``prior`` (n, C), the multipliers to change least (the start by default),
    ``damping`` and ``anchor_weight`` (n,). Arrays are those of numpy or of JAX.
    """

    forward: ForwardMap
    atol: Any
    rtol: float = 0.0

    def init(
        self, fn: Any, y: Any, args: Any, options: Options, *rest: Any
    ) -> LeastChangeState:
        """Evaluate the residuals at multipliers ``y`` (n, C)."""
        given = self.options(y, y) | options
        displacement = blocked_matmul(y - given["prior"], self.forward.inverse_root.T)
        return LeastChangeState(
            fn(y, args)[0], displacement, given["damping"], given["anchor_weight"]
        )

    def step(
        self,
        fn: Any,
        y: Any,
        args: Any,
        options: Options,
        state: LeastChangeState,
        *rest: Any,
    ) -> Stepped:
        """Take one step in every problem whose distance exceeds the tolerance; no
        squared residual increases.
        """
        where = y.__array_namespace__().where
        # Δx = A⁺ (t − r + A d) − d, and p changes by R Δx.
        anchored = state.displacement * state.anchor_weight[:, None]
        change = anchored_step(self.forward, y, state.residual, state.damping, anchored)
        trial = y + blocked_matmul(change, self.forward.root.T)
        left, aux = fn(trial, args)
        # A step is accepted where it reduces the squared residual; μ follows the
        # success of the linearisation.
        better = ((left**2).sum(axis=1) < (state.residual**2).sum(axis=1)) & (
            abs(trial).max(axis=1) <= MAX_MULTIPLIER
        )
        accept = (better & ~self.done(state))[:, None]
        after = LeastChangeState(
            residual=where(accept, left, state.residual),
            displacement=where(accept, state.displacement + change, state.displacement),
            damping=where(better, state.damping / 4, state.damping * 4),
            anchor_weight=where(better, state.anchor_weight, 0.0),
        )
        return where(accept, trial, y), after, aux

    def done(self, state: LeastChangeState) -> Any:
        return abs(state.residual).max(axis=1) <= self.atol

    def resume(self, options: Options, y: Any, state: LeastChangeState) -> Options:
        """Go on with the damping and the weight reached."""
        return {"damping": state.damping, "anchor_weight": state.anchor_weight}

    @staticmethod
    def options(start: Array, prior: Array | None) -> Options:
        """Change the prior least, or without one the current multipliers in
        each step.
        """
        count = len(start)
        given = {
            "damping": np.full(count, FIRST_DAMPING),
            "anchor_weight": np.full(count, float(prior is not None)),
        }
        return {"prior": start if prior is None else prior, **given}

    @staticmethod
    def schedule() -> Iterator[int]:
        """One step at a time while most problems converge, then several, to pass
        through fewer batches.
        """
        return chain(repeat(1, SINGLE_STEPS), repeat(MORE_STEPS))


class Solution(NamedTuple):
    """Result of `solve`."""

    multipliers: Array
    """(n, C) multipliers."""
    residual: Array
    """(n, 3) target minus RGB."""
    distance: Array
    """(n,) max |target − RGB|."""
    steps: NDArray[np.int64]
    """(n,) steps that the batches of a problem took."""


def solve(
    forward: ForwardMap,
    start: Array,
    target: Array,
    tolerance: float,
    max_passes: int,
    prior: Array | None = None,
    method: Method = LeastChange,
) -> Solution:
    """Find multipliers of linear RGB ``target`` (n, 3), from ``start`` (n, C), nearest
    to ``prior`` (n, C).

    Without a prior each step changes the current multipliers least, which is more
    robust far from the answer. No squared residual increases. Failure to converge is
    not an error: the distance reports it. The steps of a problem do not depend on the
    others.
    """
    count = len(start)
    advance = _advance(method)  # type: ignore[arg-type]
    unknown = np.full((count, 3), np.inf)
    solution = Solution(
        start.copy(), unknown, unknown[:, 0].copy(), np.zeros(count, dtype=np.int64)
    )
    rows: Any = slice(None)
    stale = np.zeros(count, dtype=np.int64)
    options = method.options(start, prior)
    for steps in islice(method.schedule(), max_passes):
        if not stale.size:
            break
        before = Solution(*(column[rows] for column in solution))
        given = (before.multipliers, target[rows], options)
        y, residual, taken, changed = map_batches(
            advance, (forward, tolerance, steps), *given
        )
        # Sums by columns, whose rounding is the same on every processor
        closer = reduce(np.add, residual.T**2) <= reduce(np.add, before.residual.T**2)
        distance = np.where(closer, largest(np.abs(residual)), before.distance)
        stale = np.where(distance > (1 - MIN_GAIN) * before.distance, stale + 1, 0)
        y, residual = (
            np.where(closer[:, None], *pair)
            for pair in ((y, before.multipliers), (residual, before.residual))
        )
        for column, values in zip(
            solution, (y, residual, distance, before.steps + taken), strict=True
        ):
            column[rows] = values
        # Converged and abandoned problems leave the batch.
        kept = (distance > tolerance) & (stale < PATIENCE)
        rows = np.arange(count)[rows][kept]
        stale = stale[kept]
        options = {name: array[kept] for name, array in (options | changed).items()}
    return solution


def residuals(
    forward: ForwardMap, multipliers: Array, target: Array, method: Method
) -> Array:
    """Target minus RGB (n, 3), by the program that is compiled for `solve`."""
    given = (multipliers, target, method.options(multipliers, None))
    residual: Array = map_batches(_advance(method), (forward, 0.0, 0), *given)[1]  # type: ignore[arg-type]
    return residual


@cache
def _advance(method: Method) -> Callable[..., Any]:
    """Make the function that takes up to a number of steps in a chunk of rows; the
    options go on from there.
    """

    def advance(
        constants: Any, y: jax.Array, target: jax.Array, options: Options
    ) -> Any:
        forward, tolerance, max_steps = constants
        solver = method(forward, tolerance)
        residual = compiled(ForwardMap.residual)
        y, state, steps = iterate(
            solver,
            lambda p, goal: (residual(forward, p, goal), None),
            y,
            args=target,
            options=options,
            max_steps=max_steps,
        )
        return (
            y,
            state.residual,
            jnp.full(len(y), steps),
            solver.resume(options, y, state),
        )

    return advance


def iterate(
    solver: Any, fn: Any, y: Any, args: Any, options: Options, max_steps: Any
) -> tuple[Any, Any, Any]:
    """Step a solver of optimistix by hand until it terminates, as its documentation
    shows for interactive use.

    Returns the last ``y``, the state and the number of steps.
    `optimistix.least_squares` takes the same steps, but takes longer to compile.
    """
    state = solver.init(fn, y, args, options, *jax.eval_shape(fn, y, args), NO_TAGS)
    arrays, static = equinox.partition(state, equinox.is_array)

    def step(carry: Any) -> Any:
        count, y, arrays = carry
        y, state, _ = solver.step(
            fn, y, args, options, equinox.combine(arrays, static), NO_TAGS
        )
        return count + 1, y, equinox.filter(state, equinox.is_array)

    def unfinished(carry: Any) -> Any:
        count, y, arrays = carry
        done, _ = solver.terminate(
            fn, y, args, options, equinox.combine(arrays, static), NO_TAGS
        )
        return (count < max_steps) & ~done

    count, y, arrays = jax.lax.while_loop(unfinished, step, (jnp.asarray(0), y, arrays))
    return y, equinox.combine(arrays, static), count


def solve_in_numpy(
    forward: ForwardMap, start: Array, target: Array, tolerance: float, max_steps: int
) -> Array:
    """Find multipliers (n, C) of linear RGB (n, 3) by minimum-norm steps from ``start``
    (n, C), in blocks of rows; those that are solved leave their block.

    Nothing is compiled, which pays for a few problems.
    """

    def residual(y: Array, goal: Array) -> tuple[Array, None]:
        return forward.residual(y, goal), None

    solver = LeastChange(forward, tolerance)
    y = start.copy()
    for block in blocks(len(y), NUMPY_ROWS):
        rows = np.arange(block.start, block.stop)
        options = LeastChange.options(y[block], None)
        state = solver.init(residual, y[rows], target[rows], options)
        for _ in range(max_steps):
            y[rows], state, _ = solver.step(residual, y[rows], target[rows], {}, state)
            kept = ~solver.done(state)
            rows = rows[kept]
            state = LeastChangeState(*(array[kept] for array in state))
            if not rows.size:
                break
    return y
