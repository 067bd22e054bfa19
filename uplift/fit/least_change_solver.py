"""The step of least change as a solver of optimistix, for its `least_squares`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import equinox
import jax
import jax.numpy as jnp
import optimistix

from uplift.fit.least_change import FIRST_DAMPING, LeastChangeState, begin, step
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap


class LeastChange(optimistix.AbstractLeastSquaresSolver):  # type: ignore[misc]
    """Damped steps of least change for a batch of problems with three residuals each.

    The options of `init` are ``prior`` (n, C), the multipliers to change least (``y`` by default), and ``damping`` and
    ``pull`` (n,) of an earlier state.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to RGB.
    atol : float
        Residual of each component, in linear RGB, at which a problem is solved.
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
        damping = options.get("damping", FIRST_DAMPING * ones)
        prior, pull = options.get("prior", y), options.get("pull", ones)
        return begin(self.forward, lambda p: fn(p, args)[0], y, prior, damping, pull)

    def step(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: LeastChangeState, tags: Any
    ) -> tuple[Any, LeastChangeState, Any]:
        """Take one step in every problem that is not solved."""
        aux = None

        def off(p: Any) -> Any:
            nonlocal aux
            residual, aux = fn(p, args)
            return residual

        y, state = step(self.model, self.forward, off, y, state, self.atol)
        return y, state, aux

    def terminate(
        self, fn: Any, y: Any, args: Any, options: dict[str, Any], state: LeastChangeState, tags: Any
    ) -> tuple[jax.Array, Any]:
        """Whether all problems are solved."""
        return (state.distance <= self.atol).all(), optimistix.RESULTS.successful

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
