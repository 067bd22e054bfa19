"""Atlas entries as spectra of the model: measured shape, exact colour, other lights (docs/mathematics.md, 6)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import optimistix

from uplift.fit.solve import solve
from uplift.models import Model
from uplift.models.least_change import Forward
from uplift.sensor import Array, Light

BATCH = 64
LIGHT_WEIGHT = 0.03
"""How much a unit of CIE L*a*b* under a light weighs against the rms difference of the spectra.

More brings the lights nearer and the spectrum away: docs/accuracy.md has the curve.
"""
FLATNESS = 1e-5
"""Keeps multipliers finite where neither the spectrum nor the lights have a say."""


def fit_entries(
    model: Model,
    forward: Forward,
    measured: Array,
    rgb: Array,
    lights: Sequence[Light],
    tolerance: float,
    light_weight: float = LIGHT_WEIGHT,
) -> Array:
    """Multipliers (E, C) of measured reflectances (E, N) on the sensor's wavelengths.

    ``rgb`` (E, 3) is met to ``tolerance``; the spectrum and its colours under ``lights`` as well as they can be.
    """
    weights = np.stack([light.xyz for light in lights])
    found = [np.empty((0, model.count))]
    with jax.enable_x64(True):
        for first in range(0, len(measured), BATCH):
            batch = measured[first : first + BATCH]
            padded = np.concatenate([batch, np.full((BATCH - len(batch), batch.shape[1]), 0.5)])
            fitted = _fit_batch(model, forward.basis, weights, padded, light_weight)
            found.append(np.asarray(fitted)[: len(batch)])
    return solve(model, forward, np.concatenate(found), rgb, tolerance=tolerance, passes=16).multipliers


@partial(jax.jit, static_argnums=0)
def _fit_batch(
    model: Model, basis: jax.Array, weights: jax.Array, measured: jax.Array, light_weight: float
) -> jax.Array:
    solver = optimistix.Dogleg(rtol=1e-6, atol=1e-8)

    def residuals(multipliers: jax.Array, goal: jax.Array) -> tuple[jax.Array, ...]:
        spectrum = model.squash(basis @ multipliers)
        shape = (spectrum - goal) / np.sqrt(len(basis))
        colours = light_weight * (_lab(weights, spectrum) - _lab(weights, goal))
        return shape, colours, FLATNESS * multipliers

    def fit(goal: jax.Array) -> jax.Array:
        start = jnp.zeros(model.count)
        return optimistix.least_squares(residuals, solver, start, goal, max_steps=100, throw=False).value

    return jax.vmap(fit)(measured)


def _lab(weights: jax.Array, spectrum: jax.Array) -> jax.Array:
    """(L, 3) CIE L*a*b* under each light; `uplift.difference.lab` in a form that JAX differentiates."""
    t = (weights @ spectrum) / weights.sum(axis=2)
    linear = t * (29 / 6) ** 2 / 3 + 4 / 29
    x, y, z = jnp.where(t > (6 / 29) ** 3, jnp.cbrt(jnp.maximum(t, 1e-9)), linear).T
    return jnp.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=1)
