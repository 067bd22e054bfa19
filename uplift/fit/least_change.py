"""The step of least change as an optimistix solver: of all spectra of a colour, the one nearest to the prior.

minimise |R⁻¹ (p − p₀)|² subject to r(p) = t (docs/mathematics.md, 5), for many problems at once. Rows are independent
problems, each with its own damping.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox
import jax
import jax.numpy as jnp
import optimistix

from uplift.models import Model
from uplift.models.matmul import matmul_rows
from uplift.models.minimum_norm import ForwardMap, least_change_step
from uplift.models.roots import MAX_MULTIPLIER

FIRST_DAMPING = 1e-6
"""Initial μ; divided by four after a successful step, multiplied by four after a rejected one."""


class LeastChangeState(NamedTuple):
    """State of n problems between steps."""

    residual: jax.Array
    """(n, 3) target minus RGB."""
    moved: jax.Array
    """(n, C) difference from the prior, R⁻¹ (p − p₀)."""
    damping: jax.Array
    """(n,) μ."""
    pull: jax.Array
    """(n,) 1, or 0 once a step was rejected: a problem that hard is no longer pulled towards its prior."""


class LeastChange(optimistix.AbstractLeastSquaresSolver):  # type: ignore[misc]
    """Damped steps of least change for a batch of problems with three residuals each.

    A step is accepted where it reduces the squared residual; no residual increases. The options of `init` are
    ``prior`` (n, C), the multipliers to change least (``y`` by default), and ``damping`` and ``pull`` (n,) of an
    earlier state.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to RGB.
    atol : float
        Residual of each component, in linear RGB, at which a problem is solved.

    References
    ----------
    Nocedal & Wright 2006, "Numerical optimization", 18.1: the step solves the linearised problem.
    """

    model: Model = equinox.field(static=True)
    forward: ForwardMap
    atol: float
    rtol: float = 0.0
    norm: Callable[[Any], Any] = equinox.field(static=True, default=optimistix.max_norm)

    def init(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], f_struct: Any, aux_struct: Any, tags: Any
    ) -> LeastChangeState:
        """Evaluate the residuals at ``y`` (n, C)."""
        ones = jnp.ones(len(y))
        return LeastChangeState(
            residual=fn(y, args)[0],
            moved=matmul_rows(y - options.get("prior", y), self.forward.inverse_root.T),
            damping=options.get("damping", FIRST_DAMPING * ones),
            pull=options.get("pull", ones),
        )

    def step(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: LeastChangeState, tags: Any
    ) -> tuple[Any, LeastChangeState, Any]:
        """Take one step in every problem that is not solved."""
        change = least_change_step(
            self.model, self.forward, y, state.residual, state.damping, state.moved * state.pull[:, None]
        )
        trial = y + matmul_rows(change, self.forward.root.T)
        residual, aux = fn(trial, args)
        better = ((residual**2).sum(axis=1) < (state.residual**2).sum(axis=1)) & (
            abs(trial).max(axis=1) <= MAX_MULTIPLIER
        )
        accept = (better & ~self.solved(state))[:, None]
        after = LeastChangeState(
            residual=jnp.where(accept, residual, state.residual),
            moved=jnp.where(accept, state.moved + change, state.moved),
            damping=jnp.where(better, state.damping / 4, state.damping * 4),
            pull=jnp.where(better, state.pull, 0.0),
        )
        return jnp.where(accept, trial, y), after, aux

    def terminate(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: LeastChangeState, tags: Any
    ) -> tuple[jax.Array, Any]:
        """Whether all problems are solved."""
        return self.solved(state).all(), optimistix.RESULTS.successful

    def postprocess(
        self,
        fn: Any,
        y: Any,
        aux: Any,
        args: Any,
        options: dict[str, Any],
        state: LeastChangeState,
        tags: Any,
        result: Any,
    ) -> tuple[Any, Any, dict[str, Any]]:
        """Return the solution as it is."""
        return y, aux, {}

    def solved(self, state: LeastChangeState) -> jax.Array:
        """Which problems (n,) are solved."""
        return abs(state.residual).max(axis=1) <= self.atol
