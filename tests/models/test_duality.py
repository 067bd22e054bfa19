"""Moments and multipliers (docs/mathematics.md, 4), compared with definitions and adaptive integration."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import quad

from tests.helpers import raises
from uplift.common.errors import UpliftError
from uplift.models import duality

small = st.floats(-3, 3)


@given(arrays(float, (4, 9), elements=small))
def test_reconstruction_has_the_given_moments(multipliers):
    moments = duality.moments_from_multipliers(multipliers)
    again = duality.moments_from_multipliers(duality.multipliers_from_moments(moments))
    np.testing.assert_allclose(again, moments, atol=1e-12)


def test_moments_are_their_defining_integrals():
    multipliers = np.array([[0.3, -1.2, 0.5, 0.1]])
    moments = duality.moments_from_multipliers(multipliers)[0]
    for j, moment in enumerate(moments):

        def integrand(phi, j=j):
            x = (duality.cosine_basis(np.array([phi]), 4) @ multipliers[0])[0]
            return (0.5 + np.arctan(x) / np.pi) * np.cos(j * phi) / np.pi

        assert moment == pytest.approx(quad(integrand, -np.pi, 0, epsabs=1e-13)[0], abs=1e-12)


def test_grey_has_only_a_zeroth_moment():
    multipliers = np.zeros((3, 5))
    multipliers[:, 0] = [-1, 0, 2]
    moments = duality.moments_from_multipliers(multipliers)
    np.testing.assert_allclose(moments[:, 0], 0.5 + np.arctan([-1, 0, 2]) / np.pi, atol=1e-15)
    np.testing.assert_allclose(moments[:, 1:], 0, atol=1e-15)


def test_nearly_box_shaped_spectra_are_as_accurate():
    """A nearly black spectrum with one steep peak, compared with adaptive integration."""
    multipliers = np.array([[-2e4, 1.3e4, -4e3]])
    moments = duality.moments_from_multipliers(multipliers)[0]

    def zeroth(phi):
        x = (duality.cosine_basis(np.array([phi]), 3) @ multipliers[0])[0]
        return (0.5 + np.arctan(x) / np.pi) / np.pi

    expected = quad(zeroth, -np.pi, 0, epsabs=1e-14, limit=500)[0]
    assert moments[0] == pytest.approx(expected, abs=1e-12)


def test_black_and_white_are_moved_off_the_boundary():
    moments = np.zeros((2, 9))
    moments[1, 0] = 1
    multipliers = duality.multipliers_from_moments(moments)
    assert np.isfinite(multipliers).all()
    reflectance = 0.5 + np.arctan(multipliers @ duality.cosine_basis(np.linspace(-np.pi, 0, 9), 9).T) / np.pi
    np.testing.assert_allclose(reflectance, np.repeat([[0], [1]], 9, axis=1), atol=1e-4)


def test_exact_box_is_moved_off_the_boundary():
    """The moments of an exact box, ½ sinc-like, whose Toeplitz matrix is singular."""
    orders = np.arange(1, 9)
    box = np.concatenate([[0.5], np.sin(-orders * np.pi / 2) / (np.pi * orders)])[None]
    multipliers = duality.multipliers_from_moments(box)
    assert np.isfinite(multipliers).all()
    np.testing.assert_allclose(duality.moments_from_multipliers(multipliers), box, atol=1e-3)


@pytest.mark.parametrize("moments", [[[1.0, 1.0, 1.0]], [[0.5, 2.0, 0.0]], [[np.nan, 0, 0]], [[5.0, 0, 0]]])
def test_invalid_moments_raise(moments):
    with raises(UpliftError, "invalid-moments"):
        duality.multipliers_from_moments(np.array(moments))
