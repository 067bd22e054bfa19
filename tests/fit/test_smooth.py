"""Smooth spectra: nearly the colour, and dark where the colour is dark."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.fit.smooth import smooth
from uplift.fit.solve import solve
from uplift.models import Moments, Sigmoid
from uplift.models.minimum_norm import forward_map, residual

DARK = np.array(
    [
        (0.05, 0.001, 0.001),
        (0.02, 0.002, 0.002),
        (0.1, 0, 0),
        (0.02, 0, 0.02),
        (0.05, 0.002, 0.05),
        (0, 0.05, 0),
    ]
)


@pytest.fixture(scope="module")
def forward(sensor):
    return forward_map(Moments(9), sensor.wavelengths, sensor.matrix)


def test_the_start_is_nearly_the_colour(forward):
    rgb = np.random.default_rng(3).random((500, 3)) ** 2
    off = np.abs(residual(Moments(9), forward, smooth(Moments(9), forward)(rgb), rgb)).max(axis=1)
    assert off.max() < 0.02
    assert np.median(off) < 0.001


def test_a_dark_saturated_colour_stays_dark_outside_the_visible_range(forward):
    model = Moments(9)

    def at_760(start):
        found = solve(model, forward, start, DARK, tolerance=1e-6, max_passes=192)
        assert found.distance.max() <= 1e-6
        return model.squash(found.multipliers @ forward.basis.T)[:, 76]

    assert at_760(smooth(model, forward)(DARK)).max() < 0.4
    assert at_760(np.zeros((len(DARK), 9))).max() > 0.9  # from a grey


@pytest.mark.parametrize("model", [Moments(3), Sigmoid()], ids=lambda m: m.name)
def test_models_of_three_coefficients_start_from_a_grey(model, sensor):
    rgb = np.array([[0.2, 0.5, 0.1], [0, 0, 0], [1, 1, 1]])
    start = smooth(model, forward_map(model, sensor.wavelengths, sensor.matrix))(rgb)
    spectra = model.squash(start @ model.basis(sensor.wavelengths).T)
    assert np.ptp(spectra, axis=1).max() < 1e-12
    assert (np.diff(spectra[[1, 0, 2], 0]) > 0).all()
