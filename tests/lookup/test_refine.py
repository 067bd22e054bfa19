"""Refinement in columns: the minimum-norm steps of the fit, and the distances of a direct evaluation."""

import numpy as np
import pytest

from uplift.lookup import refine
from uplift.models import Moments, Sigmoid, minimum_norm

RNG = np.random.default_rng(12)
MODELS = [Sigmoid(), Moments(9)]


@pytest.fixture(params=MODELS, ids=lambda model: model.name)
def setting(request, sensor):
    """The forward map of a model, and 40 spectra of it."""
    forward = minimum_norm.forward_map(request.param, sensor.wavelengths, sensor.matrix)
    return forward, RNG.normal(size=(40, request.param.count)) / (1 + np.arange(request.param.count))


def test_the_step_is_that_of_the_fit(setting):
    forward, multipliers = setting
    off, damping = 0.1 * RNG.normal(size=(40, 3)), RNG.random(40)
    found = minimum_norm.minimum_norm_step(forward, forward.basis @ multipliers.T, off.T, damping).T
    expected = minimum_norm.anchored_step(forward, multipliers, off, damping, 0 * multipliers) @ forward.root.T
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-12)


def test_steps_that_increase_the_distance_are_rejected(setting):
    """The colour is unrealisable; no distance increases."""
    forward, multipliers = setting
    goal = np.tile([[3.0], [-2.0], [0.5]], 40)
    before = np.abs(forward.residual(multipliers, goal.T))
    moved = multipliers.T.copy()
    refine._descend(forward, moved, goal)
    after = forward.residual(moved.T, goal.T)
    assert np.isfinite(after).all()
    assert ((after**2).sum(axis=1) <= (before**2).sum(axis=1) * (1 + 1e-9)).all()
