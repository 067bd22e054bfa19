"""Refining in columns: the steps of least change that the fit takes, of what every evaluation would say."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.lookup import refine
from uplift.models import Moments, Sigmoid, minimum_norm

RNG = np.random.default_rng(12)
MODELS = [Sigmoid(), Moments(9)]


@pytest.fixture(params=MODELS, ids=lambda model: model.name)
def setting(request, sensor):
    """A model, its forward map, and 40 spectra of it."""
    ahead = minimum_norm.forward_map(request.param, sensor.wavelengths, sensor.matrix)
    return (
        request.param,
        ahead,
        RNG.normal(size=(40, request.param.count)) / (1 + np.arange(request.param.count)),
    )


def test_it_takes_the_fits_step(setting):
    model, ahead, multipliers = setting
    off, damping = 0.1 * RNG.normal(size=(40, 3)), RNG.random(40)
    found = refine.step(model, ahead, ahead.basis @ multipliers.T, off.T, damping).T
    np.testing.assert_allclose(
        found, minimum_norm.minimum_norm_step(model, ahead, multipliers, off, damping), rtol=1e-8, atol=1e-12
    )


def test_what_it_follows_is_what_evaluation_finds(setting, monkeypatch):
    """The distance is a sum of changes; slices of a few columns do not show."""
    model, ahead, multipliers = setting
    goal = minimum_norm.forward_rgb(model, ahead, 0.7 * multipliers).T
    monkeypatch.setattr(refine, "BLOCK_COLUMNS", 7)
    moved = multipliers.T.copy()
    distance = refine._descend(model, ahead, moved, goal)
    evaluated = np.abs(minimum_norm.residual(model, ahead, moved.T, goal.T)).max(axis=1)
    np.testing.assert_allclose(distance, evaluated, rtol=0, atol=1e-10)
    assert distance.max() <= refine.TOLERANCE


def test_steps_that_do_not_help_are_not_taken(setting):
    """No spectrum has this colour; none ends further from it than it began."""
    model, ahead, multipliers = setting
    goal = np.tile([[3.0], [-2.0], [0.5]], 40)
    before = np.abs(minimum_norm.residual(model, ahead, multipliers, goal.T))
    moved = multipliers.T.copy()
    refine._descend(model, ahead, moved, goal)
    after = minimum_norm.residual(model, ahead, moved.T, goal.T)
    assert np.isfinite(after).all()
    assert ((after**2).sum(axis=1) <= (before**2).sum(axis=1) * (1 + 1e-9)).all()
