"""The batched solver against scipy, one problem at a time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from uplift.fit.batch import CPU_BATCH_ROWS
from uplift.fit.solve import solve
from uplift.models import Moments, Sigmoid
from uplift.models.minimum_norm import forward_map, residual

RNG = np.random.default_rng(2)
TARGETS = RNG.uniform(0.05, 0.95, (40, 3))


@pytest.mark.parametrize("model", [Moments(9), Sigmoid()], ids=["moments", "sigmoid"])
def test_distances_are_at_most_those_of_scipy(model, sensor):
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(model, forward, np.zeros((40, model.count)), TARGETS, tolerance=1e-9, max_passes=40)
    for target, distance in zip(TARGETS, found.distance, strict=True):
        oracle = least_squares(
            lambda p, target=target: residual(model, forward, p[None], target[None])[0], np.zeros(model.count)
        )
        assert distance <= 1e-9 or distance <= np.abs(oracle.fun).max() * 1.01


def test_three_unknowns_have_the_multipliers_of_scipy(sensor):
    """With as many unknowns as equations the solution is unique."""
    model = Sigmoid()
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(model, forward, np.zeros((40, 3)), TARGETS, tolerance=1e-12, max_passes=40)
    for target, multipliers in zip(TARGETS[:8], found.multipliers, strict=False):
        oracle = least_squares(
            lambda p, target=target: residual(model, forward, p[None], target[None])[0],
            np.zeros(3),
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
        )
        np.testing.assert_allclose(multipliers, oracle.x, rtol=1e-5, atol=1e-6)


def test_the_distance_is_that_of_the_multipliers(sensor):
    model = Moments(5)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(model, forward, np.zeros((40, 5)), TARGETS, tolerance=1e-3, max_passes=1)
    expected = np.abs(residual(model, forward, found.multipliers, TARGETS)).max(axis=1)
    np.testing.assert_allclose(found.distance, expected, atol=1e-12)


def test_no_distance_increases(sensor):
    """Unrealisable targets are not an error: the distance reports them."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    wild = RNG.uniform(-1, 2, (50, 3))
    start = RNG.normal(size=(50, 9))
    before = (residual(model, forward, start, wild) ** 2).sum(axis=1)
    found = solve(model, forward, start, wild, tolerance=1e-6, max_passes=3)
    after = (residual(model, forward, found.multipliers, wild) ** 2).sum(axis=1)
    assert (after <= before * (1 + 1e-12)).all()
    assert np.isfinite(found.multipliers).all()
    assert (found.distance > 1e-6).any()


@pytest.mark.parametrize("max_passes", [1, 12])
def test_solutions_do_not_depend_on_the_batch(sensor, max_passes):
    """A problem has the same solution alone and among many, also if it is hard or abandoned."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    dark, wild = [[2e-4, 1e-3, 1e-5]], [[0.9, 0.0, 0.9], [1.2, -0.3, 0.5]]
    few = np.concatenate([TARGETS[:5], dark, wild])
    many = np.resize(few, (CPU_BATCH_ROWS[0] + len(few), 3))
    crowd = solve(model, forward, np.zeros((len(many), 9)), many, tolerance=1e-8, max_passes=max_passes)
    for row, target in enumerate(few):
        alone = solve(model, forward, np.zeros((1, 9)), target[None], tolerance=1e-8, max_passes=max_passes)
        for found in (row, row + len(many) - len(few)):
            np.testing.assert_allclose(crowd.multipliers[found], alone.multipliers[0], rtol=1e-9)
            assert crowd.steps[found] == alone.steps[0]


def test_no_problems_have_no_solutions():
    model = Sigmoid()
    forward = forward_map(model, np.arange(380.0, 781, 5), np.ones((3, 81)) / 81)
    assert len(solve(model, forward, np.zeros((0, 3)), np.zeros((0, 3)), tolerance=1e-6, max_passes=1).distance) == 0


def test_the_start_is_not_modified(sensor):
    model = Sigmoid()
    start = np.zeros((40, 3))
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    solve(model, forward, start, TARGETS, tolerance=1e-6, max_passes=1)
    assert not start.any()
