"""Atlas entries as spectra of the model: measured shape, exact colour, other lights (docs/mathematics.md, 6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import optimistix

from uplift.difference import spectra_apart
from uplift.fit.solve import solve
from uplift.models import Model
from uplift.models.least_change import Forward
from uplift.sensor import Array, Light

BATCH = 64
ENDS = 8
"""An end of the spectrum is this part of it: 50 nm of 380–780."""
FLATNESS = 1e-5
"""Keeps multipliers finite where neither the spectrum nor the lights have a say."""


@dataclass(frozen=True)
class Weights:
    """What a fit of an entry minds beside the rms difference of the spectra: docs/fidelity.md compares.

    ``lights`` is what a unit of CIE L*a*b* under a light weighs; ``ends`` what the two ends of the spectrum weigh
    against its middle; ``curvature`` what its second difference weighs.
    """

    lights: float = 0.03
    ends: float = 1.0
    curvature: float = 0.0


BALANCED = Weights()


@dataclass(frozen=True, eq=False)
class Entries:
    """Atlas entries as spectra of the model.

    Parameters
    ----------
    rgb, measured : (E, 3) linear RGB and (E, N) reflectances.
    multipliers : (E, C).
    error : (E,) ΔE00 between measurement and model under the reference light.
    """

    rgb: Array
    measured: Array
    multipliers: Array
    error: Array


def fit_entries(
    model: Model,
    forward: Forward,
    measured: Array,
    rgb: Array,
    lights: Sequence[Light],
    reference: Light,
    tolerance: float,
    weights: Weights = BALANCED,
) -> Entries:
    """Fit measured reflectances (E, N) on the sensor's wavelengths.

    ``rgb`` (E, 3) is met to ``tolerance``; the spectrum and its colours under ``lights`` as well as they can be.
    """
    colours = np.stack([light.xyz for light in lights])
    rows = shape_rows(measured.shape[1], weights)
    found = [np.empty((0, model.count))]
    with jax.enable_x64(True):
        for first in range(0, len(measured), BATCH):
            batch = measured[first : first + BATCH]
            padded = np.concatenate([batch, np.full((BATCH - len(batch), batch.shape[1]), 0.5)])
            fitted = _fit_batch(model, forward.basis, rows, colours, weights.lights, padded)
            found.append(np.asarray(fitted)[: len(batch)])
    start = np.concatenate(found)
    multipliers = solve(model, forward, start, rgb, tolerance=tolerance, passes=32).multipliers
    spectra = np.asarray(model.squash(multipliers @ forward.basis.T))
    error = spectra_apart(reference, spectra, measured)
    return Entries(rgb, measured, multipliers, error)


def shape_rows(count: int, weights: Weights) -> Array:
    """(R, N) what weighs a difference of spectra (N,), so that the squares of its R products sum to a mean square."""
    share = np.ones(count)
    share[: count // ENDS] = share[-(count // ENDS) :] = weights.ends
    value = np.diag(np.sqrt(share / share.sum()))
    if not weights.curvature:
        return value
    second = np.diff(np.eye(count), n=2, axis=0) * weights.curvature / np.sqrt(count)
    return np.concatenate([value, second])


@partial(jax.jit, static_argnums=0)
def _fit_batch(
    model: Model,
    basis: jax.Array,
    rows: jax.Array,
    lights: jax.Array,
    light_weight: float,
    measured: jax.Array,
) -> jax.Array:
    solver = optimistix.Dogleg(rtol=1e-6, atol=1e-8)

    def residuals(multipliers: jax.Array, goal: jax.Array) -> tuple[jax.Array, ...]:
        spectrum = model.squash(basis @ multipliers)
        colours = light_weight * (_lab(lights, spectrum) - _lab(lights, goal))
        return rows @ (spectrum - goal), colours, FLATNESS * multipliers

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
