"""Moments by roots, compared with the trapezoid rule where it converges, and by a round trip where it does not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from uplift.models import duality
from uplift.models.roots import moments_by_roots


@pytest.mark.parametrize("count", [3, 5, 9])
def test_roots_agree_with_the_trapezoid_rule(count):
    multipliers = np.random.default_rng(count).normal(size=(200, count)) * 5
    found = moments_by_roots(multipliers)
    np.testing.assert_allclose(found, duality.moments_from_multipliers(multipliers), rtol=0, atol=1e-9)


def test_steps_narrower_than_the_nodes():
    """Compared with adaptive integration with break points at the steps."""
    multipliers = np.array([[-0.3e6, 1e6, 0.4e6]])

    def integrand(phi, order):
        x = multipliers[0] @ np.array([1, 2 * np.cos(phi), 2 * np.cos(2 * phi)])
        return (0.5 + np.arctan(x) / np.pi) * np.cos(order * phi) / np.pi

    steps = [np.arccos(y) - np.pi for y in np.roots([1.6e6, 2e6, -1.1e6]).real if abs(y) < 1]
    for order, moment in enumerate(moments_by_roots(multipliers)[0]):
        expected = quad(integrand, -np.pi, 0, args=(order,), points=steps, limit=2000, epsabs=1e-12)[0]
        assert moment == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("level", [-1e5, 0.0, 1e5])
def test_grey_has_only_remote_roots(level):
    multipliers = np.zeros((1, 9))
    multipliers[:, 0] = level
    expected = np.zeros((1, 9))
    expected[:, 0] = 0.5 + np.arctan(level) / np.pi
    np.testing.assert_allclose(moments_by_roots(multipliers), expected, atol=1e-6)


def test_boxes_survive_a_round_trip():
    """Spectra of two steps within a hundred thousandth of the phase: unchanged by storage."""
    edges = np.random.default_rng(4).uniform(-2.8, -0.3, (50, 2))
    cosine = np.cos(edges)
    # −10⁵ (cos φ − cos φ₁)(cos φ − cos φ₂) as a series of cosines
    series = np.zeros((50, 9))
    series[:, 0] = 0.5 + cosine.prod(axis=1)
    series[:, 1] = -cosine.sum(axis=1) / 2
    series[:, 2] = 0.25
    multipliers = -1e5 * series
    stored = duality.moments_from_multipliers(multipliers)
    again = duality.multipliers_from_moments(stored)
    phase = np.linspace(-np.pi, 0, 41)
    spectra = [0.5 + np.arctan(p @ duality.cosine_basis(phase, 9).T) / np.pi for p in (multipliers, again)]
    assert np.abs(spectra[0] - spectra[1]).max() < 1e-3
