"""The step of least change is a solver of optimistix, and its answer the spectrum nearest to the prior."""

from __future__ import annotations

import jax
import numpy as np
import optimistix
import pytest
from scipy.optimize import minimize

from uplift.fit.least_change_solver import LeastChange
from uplift.fit.solve import solve
from uplift.models import Moments
from uplift.models.minimum_norm import forward_map, residual

MODEL = Moments(5)
RNG = np.random.default_rng(5)
TARGETS = RNG.uniform(0.2, 0.8, (6, 3))
PRIORS = RNG.normal(size=(6, 5)) / 5


@pytest.fixture(scope="module")
def forward(sensor):
    return forward_map(MODEL, sensor.wavelengths, sensor.matrix)


def test_optimistix_runs_it(forward):
    with jax.enable_x64(True):
        found = optimistix.least_squares(
            lambda y, target: residual(MODEL, forward, y, target),
            LeastChange(MODEL, forward, 1e-9),
            PRIORS,
            args=TARGETS,
        )
    off = residual(MODEL, forward, np.asarray(found.value), TARGETS)
    assert np.abs(off).max() <= 1e-9
    ours = solve(MODEL, forward, PRIORS, TARGETS, tolerance=1e-9, max_passes=20, prior=PRIORS)
    np.testing.assert_allclose(found.value, ours.multipliers, atol=1e-9)


def test_the_answer_is_the_nearest_to_the_prior(forward):
    """scipy minimises the distance from the prior under the constraint of the colour."""
    found = solve(MODEL, forward, PRIORS, TARGETS, tolerance=1e-12, max_passes=40, prior=PRIORS)
    for prior, target, multipliers in zip(PRIORS, TARGETS, found.multipliers, strict=True):
        oracle = minimize(
            lambda p, prior=prior: ((forward.inverse_root @ (p - prior)) ** 2).sum(),
            prior,
            method="SLSQP",
            tol=1e-14,
            constraints={
                "type": "eq",
                "fun": lambda p, target=target: residual(MODEL, forward, p[None], target[None])[0],
            },
        )
        np.testing.assert_allclose(multipliers, oracle.x, atol=2e-4)


def test_the_answer_does_not_depend_on_the_start(forward):
    starts = PRIORS + 0.05 * RNG.normal(size=PRIORS.shape)
    one, other = (
        solve(MODEL, forward, start, TARGETS, tolerance=1e-12, max_passes=40, prior=PRIORS)
        for start in (PRIORS, starts)
    )
    np.testing.assert_allclose(one.multipliers, other.multipliers, atol=1e-5)
    without = solve(MODEL, forward, starts, TARGETS, tolerance=1e-12, max_passes=40)
    assert np.abs(without.multipliers - one.multipliers).max() > 1e-3
