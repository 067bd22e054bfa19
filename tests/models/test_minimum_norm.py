"""Steps towards a colour compared with dense linear algebra."""

import jax
import numpy as np
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


def step(forward, residuals, damping=0.0):
    """Minimum-norm steps (n, 9) from `POINTS`."""
    linear = forward.basis @ POINTS.T
    return minimum_norm_step(
        forward, linear, residuals.T, np.full(len(POINTS), damping)
    ).T


def numeric_jacobian(forward, multipliers, target):
    columns = []
    for nudge in 1e-6 * np.eye(len(multipliers)):
        residuals = [
            forward.residual((multipliers + s * nudge)[None], target[None])[0]
            for s in (-1, 1)
        ]
        columns.append((residuals[0] - residuals[1]) / 2e-6)
    return np.stack(columns, axis=1)


def test_step_agrees_with_its_formula(sensor):
    """Δp = M⁻¹Jᵀ(J M⁻¹Jᵀ)⁻¹ r, J by differences and the rest by a dense solver; nothing
    in the null space.
    """
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = forward.residual(POINTS, TARGETS)
    metric = np.linalg.inv(forward.root @ forward.root.T)
    for p, t, r, dp in zip(
        POINTS, TARGETS, residuals, step(forward, residuals), strict=True
    ):
        jacobian = numeric_jacobian(forward, p, t)
        weighted = (forward.root @ forward.root.T) @ jacobian.T
        assert_allclose(
            dp, weighted @ np.linalg.solve(jacobian @ weighted, r), rtol=1e-4, atol=1e-6
        )
        assert_allclose(jacobian @ dp, r, atol=1e-6)
        sideways = np.linalg.svd(jacobian)[2][3:]
        assert np.abs(sideways @ metric @ dp).max() < 1e-4 * np.linalg.norm(metric @ dp)


def test_anchored_step_agrees_with_its_formula(sensor):
    """Δx = A⁺ (t − r + A d) − d."""
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    residuals = forward.residual(POINTS, TARGETS)
    displacement = RNG.normal(size=POINTS.shape)
    found = anchored_step(
        forward, POINTS, residuals, np.zeros(len(POINTS)), displacement
    )
    for p, t, r, d, dx in zip(
        POINTS, TARGETS, residuals, displacement, found, strict=True
    ):
        a = numeric_jacobian(forward, p, t) @ forward.root
        assert_allclose(dx, np.linalg.pinv(a) @ (r + a @ d) - d, rtol=1e-4, atol=1e-5)


def test_jax_and_numpy_agree(sensor):
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    arrays = (
        POINTS,
        forward.residual(POINTS, TARGETS),
        np.full(len(POINTS), 1e-2),
        0.1 * POINTS,
    )
    here = anchored_step(forward, *arrays)
    with jax.enable_x64(True):
        there = jax.jit(anchored_step)(forward, *arrays)
        assert_allclose(np.asarray(there), here, rtol=1e-8)


def lower_half(matrices):
    columns = np.moveaxis(matrices, 0, -1)
    return [list(columns[row, : row + 1]) for row in range(3)]


def test_damped_solution_agrees_with_a_dense_solver():
    roots = RNG.normal(size=(50, 3, 5))
    matrices = roots @ roots.transpose(0, 2, 1)
    right = RNG.normal(size=(50, 3))
    damping = RNG.random(50)
    shift = damping * np.trace(matrices, axis1=1, axis2=2)
    expected = np.linalg.solve(
        matrices + shift[:, None, None] * np.eye(3), right[..., None]
    )[..., 0]
    found = np.stack(solve_damped(lower_half(matrices), damping, right.T), axis=1)
    assert_allclose(found, expected, rtol=1e-7)


def test_singular_matrices_give_finite_steps():
    singular = np.array([np.zeros((3, 3)), np.ones((3, 3)), np.diag([1.0, 1e-30, 0.0])])
    assert np.isfinite(
        solve_damped(lower_half(singular), np.zeros(3), np.full((3, 3), 1e-3))
    ).all()
