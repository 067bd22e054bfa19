"""Moments and multipliers (docs/mathematics.md, 4), compared with definitions and
adaptive integration.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose
from scipy.integrate import quad

from tests.helpers import raises
from uplift.common.errors import UpliftError
from uplift.lab.study.unmirrored import try_complex_multipliers
from uplift.models import duality

small = st.floats(-3, 3)


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


def test_black_and_white_are_moved_off_the_boundary():
    moments = np.zeros((2, 9))
    moments[1, 0] = 1
    multipliers = duality.multipliers_from_moments(moments)
    assert np.isfinite(multipliers).all()
    reflectance = (
        0.5
        + np.arctan(multipliers @ duality.cosine_basis(np.linspace(-np.pi, 0, 9), 9).T)
        / np.pi
    )
    assert_allclose(reflectance, np.repeat([[0], [1]], 9, axis=1), atol=1e-4)


@pytest.mark.parametrize(
    "moments", [[[1.0, 1.0, 1.0]], [[0.5, 2.0, 0.0]], [[np.nan, 0, 0]], [[5.0, 0, 0]]]
)
def test_invalid_moments_raise(moments):
    with raises(UpliftError, "invalid-moments"):
        duality.multipliers_from_moments(np.array(moments))


@pytest.mark.parametrize("count", [3, 9, 17])
@given(values=arrays(float, (5, 17), elements=st.floats(-3, 3)))
def test_arithmetic_on_the_circle_agrees(count, values):
    moments = duality.moments_from_multipliers(values[:, :count])
    found, valid = duality.try_multipliers(moments)
    expected, valid_on_circle = try_complex_multipliers(moments.astype(complex))
    assert valid.all()
    assert valid_on_circle.all()
    assert_allclose(found, expected, rtol=0, atol=1e-11 * (1 + np.abs(expected).max()))


@pytest.mark.parametrize(
    ("solve", "kind"),
    [(duality.try_multipliers, float), (try_complex_multipliers, complex)],
)
def test_moments_outside_the_moment_space_are_invalid(solve, kind):
    moments = np.array(
        [
            [0.5, 0.1, 0.0],
            [0.5, 0.4, 0.0],
            [1.5, 0.1, 0.0],
            [np.nan, 0, 0],
            [0.0, 0.1, 0.0],
        ]
    )
    assert solve(moments.astype(kind))[1].tolist() == [True, False, False, False, False]


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


def test_boxes_survive_a_round_trip():
    """Spectra of two steps within a hundred thousandth of the phase: unchanged by
    storage.
    """
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
    spectra = [
        0.5 + np.arctan(p @ duality.cosine_basis(phase, 9).T) / np.pi
        for p in (multipliers, again)
    ]
    assert np.abs(spectra[0] - spectra[1]).max() < 1e-3
