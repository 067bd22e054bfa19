"""Spectra whose colour survives the rounding of coefficients to single precision."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.models import Moments, Phase, Sigmoid, evaluate

MODELS = [Moments(3), Moments(9), Moments(17), Moments(9, Phase(warp="vision")), Sigmoid()]
LIMIT = 2e-7


def colours(model, multipliers, sensor):
    return sensor.rgb(evaluate(model, multipliers, sensor.wavelengths))


def change(model, multipliers, sensor):
    """Change of linear RGB (n,) when coefficients are rounded."""
    rounded = model.from_storage(model.to_storage(multipliers).astype(np.float32))
    return np.abs(colours(model, rounded, sensor) - colours(model, multipliers, sensor)).max(axis=1)


@pytest.mark.parametrize("model", MODELS, ids=lambda m: f"{m.name}{m.count}")
def test_safe_spectra_keep_their_colour(model, sensor):
    rng = np.random.default_rng(3)
    multipliers = rng.normal(size=(4000, model.count)) * 10 ** rng.uniform(-2, 2, (4000, 1))
    safe = model.rounds_safely(multipliers)
    assert safe.sum() > 500
    assert change(model, multipliers[safe], sensor).max() <= LIMIT


def test_the_criterion_is_needed(sensor):
    """Nearly box-shaped spectra change more."""
    boxes = np.random.default_rng(4).normal(size=(200, 9)) * 1e5
    assert not Moments(9).rounds_safely(boxes).any()
    assert change(Moments(9), boxes, sensor).max() > LIMIT
