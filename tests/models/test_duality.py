"""Moments and multipliers (docs/mathematics.md, 4), compared with definitions and
adaptive integration.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from tests.helpers import raises
from uplift.common.errors import UpliftError
from uplift.lab.study.unmirrored import try_complex_multipliers
from uplift.models import duality


def test_moments_are_their_defining_integrals():
    multipliers = np.array([[0.3, -1.2, 0.5, 0.1]])
    moments = duality.moments_from_multipliers(multipliers)[0]
    for j, moment in enumerate(moments):

        def integrand(phi, j=j):
            x = (duality.cosine_basis(np.array([phi]), 4) @ multipliers[0])[0]
            return (0.5 + np.arctan(x) / np.pi) * np.cos(j * phi) / np.pi

        assert moment == pytest.approx(
            quad(integrand, -np.pi, 0, epsabs=1e-13)[0], abs=1e-12
        )


@pytest.mark.parametrize(
    "moments", [[[1.0, 1.0, 1.0]], [[0.5, 2.0, 0.0]], [[np.nan, 0, 0]], [[5.0, 0, 0]]]
)
def test_invalid_moments_raise(moments):
    with raises(UpliftError, "invalid-moments"):
        duality.multipliers_from_moments(np.array(moments))


@pytest.mark.parametrize("count", [3, 5, 9])
def test_roots_agree_with_the_trapezoid_rule(count):
    multipliers = np.random.default_rng(count).normal(size=(200, count)) * 5
    found = duality.moments_by_roots(multipliers)
    assert_allclose(
        found, duality.moments_from_multipliers(multipliers), rtol=0, atol=1e-9
    )


def test_steps_narrower_than_the_nodes():
    """Compared with adaptive integration with break points at the steps."""
    multipliers = np.array([[-0.3e6, 1e6, 0.4e6]])

    def integrand(phi, order):
        x = multipliers[0] @ np.array([1, 2 * np.cos(phi), 2 * np.cos(2 * phi)])
        return (0.5 + np.arctan(x) / np.pi) * np.cos(order * phi) / np.pi

    steps = [
        np.arccos(y) - np.pi for y in np.roots([1.6e6, 2e6, -1.1e6]).real if abs(y) < 1
    ]
    for order, moment in enumerate(duality.moments_by_roots(multipliers)[0]):
        expected = quad(
            integrand, -np.pi, 0, args=(order,), points=steps, limit=2000, epsabs=1e-12
        )[0]
        assert moment == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("count", [3, 9, 17])
def test_arithmetic_on_the_circle_agrees(count):
    """Also on moments outside the moment space."""
    multipliers = np.random.default_rng(count).uniform(-3, 3, (50, count))
    moments = duality.moments_from_multipliers(multipliers)
    moments[-2:, 0] = np.nan, 1.5
    moments[-3, 1] = 0.4
    found, valid = duality.try_multipliers(moments)
    expected, valid_on_circle = try_complex_multipliers(moments.astype(complex))
    for each in (valid, valid_on_circle):
        assert each[:-3].all()
        assert not each[-3:].any()
    within = 1e-11 * (1 + np.abs(expected[valid]).max())
    assert_allclose(found[valid], expected[valid], rtol=0, atol=within)


def test_boxes_survive_a_round_trip():
    """Spectra of two steps within a hundred thousandth of the phase: unchanged by
    storage.
    """
    cosine = np.cos(np.random.default_rng(4).uniform(-2.8, -0.3, (50, 2)))
    # −10⁵ (cos φ − cos φ₁)(cos φ − cos φ₂) as a series of cosines
    multipliers = np.zeros((50, 9))
    multipliers[:, 0] = -1e5 * (0.5 + cosine.prod(axis=1))
    multipliers[:, 1] = 1e5 * cosine.sum(axis=1) / 2
    multipliers[:, 2] = -1e5 / 4
    stored = duality.moments_from_multipliers(multipliers)
    basis = duality.cosine_basis(np.linspace(-np.pi, 0, 41), 9)
    before, after = (
        np.arctan(each @ basis.T) / np.pi
        for each in (multipliers, duality.multipliers_from_moments(stored))
    )
    assert np.abs(before - after).max() < 1e-3
