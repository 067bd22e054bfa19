"""Steps towards a colour compared with dense linear algebra."""

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift.fit.batch  # noqa: F401  (makes the forward map a pytree)
from uplift.models.minimum_norm import (
    anchored_step,
    forward_map,
    minimum_norm_step,
    solve_damped,
)
from uplift.models.moments import Moments

MODEL = Moments(9)
RNG = np.random.default_rng(8)
POINTS = RNG.normal(size=(30, 9)) / (1 + np.arange(9))
TARGETS = RNG.random((30, 3))


@pytest.fixture(scope="module")
def forward(sensor):
    return forward_map(MODEL, sensor.wavelengths, sensor.matrix)


def jacobian(forward, multipliers, target):
    """Derivatives (3, 9) of the colour by differences."""
    nudged = multipliers + 1e-6 * np.concatenate([np.eye(9), -np.eye(9)])
    above, below = np.split(forward.residual(nudged, target[None]), 2)
    return (below - above).T / 2e-6


def test_steps_agree_with_their_formulas(forward):
    """Δp = M⁻¹Jᵀ(J M⁻¹Jᵀ)⁻¹ r, and Δx = A⁺ (r + A d) − d, J by differences and the rest
    by a dense solver.
    """
    residuals = forward.residual(POINTS, TARGETS)
    undamped = np.zeros(len(POINTS))
    linear = forward.basis @ POINTS.T
    steps = minimum_norm_step(forward, linear, residuals.T, undamped).T
    away = RNG.normal(size=POINTS.shape)
    anchored = anchored_step(forward, POINTS, residuals, undamped, away)
    for row, (point, target, r) in enumerate(
        zip(POINTS, TARGETS, residuals, strict=True)
    ):
        j = jacobian(forward, point, target)
        weighted = (forward.root @ forward.root.T) @ j.T
        expected = weighted @ np.linalg.solve(j @ weighted, r)
        assert_allclose(steps[row], expected, rtol=1e-4, atol=1e-6)
        a = j @ forward.root
        expected = np.linalg.pinv(a) @ (r + a @ away[row]) - away[row]
        assert_allclose(anchored[row], expected, rtol=1e-4, atol=1e-5)


def test_jax_and_numpy_agree(forward):
    residuals = forward.residual(POINTS, TARGETS)
    arrays = (POINTS, residuals, np.full(len(POINTS), 1e-2), 0.1 * POINTS)
    here = anchored_step(forward, *arrays)
    with jax.enable_x64(True):
        there = jax.jit(anchored_step)(forward, *arrays)
        assert_allclose(np.asarray(there), here, rtol=1e-8)


def solved(matrices, damping, right):
    columns = np.moveaxis(matrices, 0, -1)
    lower = [list(columns[row, : row + 1]) for row in range(3)]
    return np.stack(solve_damped(lower, damping, right.T), axis=1)


def test_damped_solution_agrees_with_a_dense_solver_and_is_finite():
    roots = RNG.normal(size=(50, 3, 5))
    matrices = roots @ roots.mT
    right = RNG.normal(size=(50, 3))
    damping = RNG.random(50)
    shift = damping * np.trace(matrices, axis1=1, axis2=2)
    damped = matrices + shift[:, None, None] * np.eye(3)
    expected = np.linalg.solve(damped, right[..., None])[..., 0]
    assert_allclose(solved(matrices, damping, right), expected, rtol=1e-7)
    singular = np.array([np.zeros((3, 3)), np.ones((3, 3)), np.diag([1.0, 1e-30, 0.0])])
    assert np.isfinite(solved(singular, np.zeros(3), np.full((3, 3), 1e-3))).all()
