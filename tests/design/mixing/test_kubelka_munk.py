"""Kubelka–Munk theory: numerical integration, eq. 10.11 as printed, limits, and composition of layers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.design.mixing import kubelka_munk as km
from uplift.design.mixing.pigments import Pigment

SEVERAL = Pigment(np.array([0.3, 2.0, 0.01]), np.array([1.5, 0.2, 4.0]))


def printed(K, S, X, ground):
    """Return R by eq. 10.11, which is undefined for S = 0 or K = 0."""
    a = (S + K) / S
    b = np.sqrt(a**2 - 1)
    coth = 1 / np.tanh(b * S * X)
    return (1 - ground * (a - b * coth)) / (a - ground + b * coth)


def test_the_differential_equations_are_satisfied():
    """(10.1), y going down and z up, on a ground."""
    X, ground, K, S = 0.8, 0.4, 0.7, 1.9

    def slopes(_, flux):
        y, z = flux
        return np.stack([-(K + S) * y + S * z, (K + S) * z - S * y])

    def ends(top, bottom):
        return np.array([top[0] - 1, bottom[1] - ground * bottom[0]])

    x = np.linspace(0, X, 50)
    solved = solve_bvp(slopes, ends, x, np.ones((2, 50)), tol=1e-10)
    found = km.layer(Pigment(np.array([K]), np.array([S])), X)
    assert found.over(ground)[0] == pytest.approx(solved.y[1, 0], abs=1e-8)
    crossed = found.transmittance / (1 - found.reflectance * ground)
    assert crossed[0] == pytest.approx(solved.y[0, -1], abs=1e-8)


@pytest.mark.parametrize("X", [0.01, 1.0, 20.0])
@pytest.mark.parametrize("ground", [0.0, 0.5, 1.0])
def test_reflectance_on_a_ground_follows_kubelka_1948(X, ground):
    expected = printed(SEVERAL.absorption, SEVERAL.scattering, X, ground)
    np.testing.assert_allclose(km.layer(SEVERAL, X).over(ground), expected)


def test_the_thesis_s_example():
    """10.2.3: K .1 and .3, S .4 and .2, mixed 2:1: S/K = 2 and R = .38."""
    mixture = Pigment(np.array([[0.1], [0.3]]), np.array([[0.4], [0.2]])).mix([2, 1])
    assert mixture.scattering / mixture.absorption == pytest.approx(2)
    assert km.opaque_reflectance(mixture)[0] == pytest.approx(0.38, abs=0.005)


def test_two_layers_equal_one_of_their_total_thickness(paint):
    both = km.layer(paint, 0.7).stack_on(km.layer(paint, 1.6))
    one = km.layer(paint, 2.3)
    np.testing.assert_allclose(both.reflectance, one.reflectance, rtol=1e-10)
    np.testing.assert_allclose(both.transmittance, one.transmittance, rtol=1e-10)
    np.testing.assert_allclose(km.layer(paint, 0.7).over(km.layer(paint, 1.6).over(0.3)), one.over(0.3), rtol=1e-10)


@pytest.mark.parametrize("X", [0.0, 1e-9, 1.0, 1e3, 1e9, 1e300])
def test_energy_is_not_created(paint, X):
    found = km.layer(paint, X)
    assert (found.reflectance >= 0).all()
    assert (found.transmittance >= 0).all()
    assert (found.reflectance + found.transmittance <= 1 + 1e-12).all()
    assert (found.over(1.0) <= 1 + 1e-12).all()


def test_energy_is_conserved_without_absorption():
    """K → 0: R = SX / (1 + SX), and T = 1 − R."""
    found = km.layer(Pigment(np.zeros(2), np.array([0.5, 3.0])), 2.0)
    np.testing.assert_allclose(found.reflectance, [1 / 2, 6 / 7])
    np.testing.assert_allclose(found.transmittance, [1 / 2, 1 / 7])
    assert found.over(1.0) == pytest.approx(1)


def test_without_scattering_beer_s_law_holds():
    found = km.layer(Pigment(np.array([0.5, 3.0]), np.zeros(2)), 2.0)
    np.testing.assert_allclose(found.transmittance, np.exp([-1, -6]))
    assert not found.reflectance.any()


def test_limits_are_continuous():
    for K, S in (([0, 1e-12], [2, 2]), ([2, 2], [0, 1e-12]), ([0, 1e-13], [0, 1e-13])):
        found = km.layer(Pigment(np.array(K, float), np.array(S, float)), 1.5)
        for values in (found.reflectance, found.transmittance):
            assert values[1] == pytest.approx(values[0], abs=1e-6)


def test_thick_paint_hides_its_ground(paint):
    opaque = Pigment(paint.absorption[3:], paint.scattering[3:])
    found = km.layer(opaque, 1e7)
    np.testing.assert_allclose(found.over(1.0), km.opaque_reflectance(opaque), rtol=1e-9)
    np.testing.assert_allclose(found.over(0.0), km.opaque_reflectance(opaque), rtol=1e-9)


def test_opaque_paint_at_the_limits():
    found = km.opaque_reflectance(Pigment(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])))
    np.testing.assert_array_equal(found, [1, 0, 0])


def test_thickness_0_shows_the_ground():
    np.testing.assert_array_equal(km.layer(SEVERAL, 0.0).over([0.1, 0.5, 1]), [0.1, 0.5, 1])


def test_thickness_can_be_an_image(rng):
    """A thickness for each pixel of (4, 5)."""
    thickness = rng.random((4, 5))
    found = km.layer(SEVERAL, thickness).over(0.6)
    assert found.shape == (4, 5, 3)
    np.testing.assert_allclose(found[2, 3], km.layer(SEVERAL, thickness[2, 3]).over(0.6))


@pytest.mark.parametrize("X", [-1, np.nan, np.inf])
def test_invalid_thickness_raises(X):
    with raises(OptionError, "invalid-thickness"):
        km.layer(SEVERAL, X)
