"""The minimum-norm step compared with dense linear algebra."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from uplift.models import Moments
from uplift.models.minimum_norm import forward_map, minimum_norm_step, residual, solve_3x3

MODEL = Moments(9)
RNG = np.random.default_rng(8)
POINTS = RNG.normal(size=(30, 9)) / (1 + np.arange(9))
TARGETS = RNG.random((30, 3))


def numeric_jacobian(forward, multipliers, target):
    columns = []
    for j in range(len(multipliers)):
        nudge = 1e-6 * np.eye(len(multipliers))[j]
        residuals = [residual(MODEL, forward, (multipliers + s * nudge)[None], target[None])[0] for s in (-1, 1)]
        columns.append((residuals[0] - residuals[1]) / 2e-6)
    return np.stack(columns, axis=1)


def test_step_agrees_with_its_formula(sensor):
    """Δp = M⁻¹Jᵀ(J M⁻¹Jᵀ)⁻¹ r, J by differences and the rest by a dense solver."""
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = residual(MODEL, forward, POINTS, TARGETS)
    found = minimum_norm_step(MODEL, forward, POINTS, residuals, np.zeros(len(POINTS)))
    for p, t, r, dp in zip(POINTS, TARGETS, residuals, found, strict=True):
        jacobian = numeric_jacobian(forward, p, t)
        weighted = (forward.root @ forward.root.T) @ jacobian.T
        expected = weighted @ np.linalg.solve(jacobian @ weighted, r)
        np.testing.assert_allclose(dp, expected, rtol=1e-4, atol=1e-6)
        np.testing.assert_allclose(jacobian @ dp, r, atol=1e-6)


def test_step_has_no_component_in_the_null_space(sensor):
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = residual(MODEL, forward, POINTS, TARGETS)
    found = minimum_norm_step(MODEL, forward, POINTS, residuals, np.zeros(len(POINTS)))
    metric = np.linalg.inv(forward.root @ forward.root.T)
    for p, t, dp in zip(POINTS, TARGETS, found, strict=True):
        jacobian = numeric_jacobian(forward, p, t)
        sideways = np.linalg.svd(jacobian)[2][3:]
        assert np.abs(sideways @ metric @ dp).max() < 1e-4 * np.linalg.norm(metric @ dp)


def test_damping_shortens_the_step(sensor):
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = residual(MODEL, forward, POINTS, TARGETS)
    free, damped = (minimum_norm_step(MODEL, forward, POINTS, residuals, np.full(len(POINTS), mu)) for mu in (0.0, 1.0))
    assert (np.linalg.norm(damped, axis=1) < np.linalg.norm(free, axis=1)).all()


def test_jax_and_numpy_agree(sensor):
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = residual(MODEL, forward, POINTS, TARGETS)
    here = minimum_norm_step(MODEL, forward, POINTS, residuals, np.full(len(POINTS), 1e-2))
    with jax.enable_x64(True):
        there = minimum_norm_step(
            MODEL, jax.device_put(forward), *map(jnp.asarray, (POINTS, residuals, np.full(len(POINTS), 1e-2)))
        )
        np.testing.assert_allclose(np.asarray(there), here, rtol=1e-8)


def lower_half(matrices):
    return [[matrices[:, a, b] for b in range(a + 1)] for a in range(3)]


def test_solve_3x3_agrees_with_a_dense_solver():
    roots = RNG.normal(size=(50, 3, 5))
    matrices = roots @ roots.transpose(0, 2, 1)
    right, shift = RNG.normal(size=(50, 3)), RNG.random(50)
    expected = np.linalg.solve(matrices + shift[:, None, None] * np.eye(3), right[..., None])[..., 0]
    found = np.stack(solve_3x3(lower_half(matrices), shift, right.T), axis=1)
    np.testing.assert_allclose(found, expected, rtol=1e-7)


def test_singular_matrices_give_finite_steps():
    singular = np.array([np.zeros((3, 3)), np.ones((3, 3)), np.diag([1.0, 1e-30, 0.0])])
    assert np.isfinite(solve_3x3(lower_half(singular), np.zeros(3), np.full((3, 3), 1e-3))).all()
