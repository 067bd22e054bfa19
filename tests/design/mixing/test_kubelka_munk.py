"""Kubelka and Munk: the equations integrated, (10.11) as printed, limits, and layers that compose."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from uplift.common.errors import OptionError
from uplift.design.mixing import kubelka_munk as km
from uplift.design.mixing.pigments import Pigment

SEVERAL = Pigment(np.array([0.3, 2.0, 0.01]), np.array([1.5, 0.2, 4.0]))


def printed(K, S, X, ground):
    """(10.11), which has no value for S = 0 or K = 0."""
    a = (S + K) / S
    b = np.sqrt(a**2 - 1)
    coth = 1 / np.tanh(b * S * X)
    return (1 - ground * (a - b * coth)) / (a - ground + b * coth)


def test_the_differential_equations_are_solved():
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
def test_it_is_the_equation_of_1948(X, ground):
    expected = printed(SEVERAL.absorption, SEVERAL.scattering, X, ground)
    np.testing.assert_allclose(km.layer(SEVERAL, X).over(ground), expected)


def test_the_thesis_s_example():
    """10.2.3: K .1 and .3, S .4 and .2, mixed 2:1: S/K = 2 and R = .38."""
    mixture = Pigment(np.array([[0.1], [0.3]]), np.array([[0.4], [0.2]])).mixed([2, 1])
    assert mixture.scattering / mixture.absorption == pytest.approx(2)
    assert km.hiding(mixture)[0] == pytest.approx(0.38, abs=0.005)


def test_two_layers_are_one_of_the_sum(paint):
    both = km.layer(paint, 0.7).upon(km.layer(paint, 1.6))
    one = km.layer(paint, 2.3)
    np.testing.assert_allclose(both.reflectance, one.reflectance, rtol=1e-10)
    np.testing.assert_allclose(both.transmittance, one.transmittance, rtol=1e-10)
    np.testing.assert_allclose(
        km.layer(paint, 0.7).over(km.layer(paint, 1.6).over(0.3)), one.over(0.3), rtol=1e-10
    )


@pytest.mark.parametrize("X", [0.0, 1e-9, 1.0, 1e3, 1e9, 1e300])
def test_energy_never_grows(paint, X):
    found = km.layer(paint, X)
    assert (found.reflectance >= 0).all()
    assert (found.transmittance >= 0).all()
    assert (found.reflectance + found.transmittance <= 1 + 1e-12).all()
    assert (found.over(1.0) <= 1 + 1e-12).all()


def test_nothing_is_lost_without_absorption():
    """K → 0: R = SX / (1 + SX), and all that is not reflected goes through."""
    found = km.layer(Pigment(np.zeros(2), np.array([0.5, 3.0])), 2.0)
    np.testing.assert_allclose(found.reflectance, [1 / 2, 6 / 7])
    np.testing.assert_allclose(found.transmittance, [1 / 2, 1 / 7])
    assert found.over(1.0) == pytest.approx(1)


def test_no_scattering_is_beer_s_law():
    found = km.layer(Pigment(np.array([0.5, 3.0]), np.zeros(2)), 2.0)
    np.testing.assert_allclose(found.transmittance, np.exp([-1, -6]))
    assert not found.reflectance.any()


def test_limits_are_approached_without_a_jump():
    for K, S in (([0, 1e-12], [2, 2]), ([2, 2], [0, 1e-12]), ([0, 1e-13], [0, 1e-13])):
        found = km.layer(Pigment(np.array(K, float), np.array(S, float)), 1.5)
        for values in (found.reflectance, found.transmittance):
            assert values[1] == pytest.approx(values[0], abs=1e-6)


def test_thick_paint_hides_its_ground(paint):
    opaque = Pigment(paint.absorption[3:], paint.scattering[3:])
    found = km.layer(opaque, 1e7)
    np.testing.assert_allclose(found.over(1.0), km.hiding(opaque), rtol=1e-9)
    np.testing.assert_allclose(found.over(0.0), km.hiding(opaque), rtol=1e-9)


def test_hiding_paint_at_the_ends():
    found = km.hiding(Pigment(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])))
    np.testing.assert_array_equal(found, [1, 0, 0])


def test_no_paint_shows_the_ground():
    np.testing.assert_array_equal(km.layer(SEVERAL, 0.0).over([0.1, 0.5, 1]), [0.1, 0.5, 1])


def test_images_of_thickness(rng):
    """A thickness for each pixel of (4, 5)."""
    thickness = rng.random((4, 5))
    found = km.layer(SEVERAL, thickness).over(0.6)
    assert found.shape == (4, 5, 3)
    np.testing.assert_allclose(found[2, 3], km.layer(SEVERAL, thickness[2, 3]).over(0.6))


@pytest.mark.parametrize("X", [-1, np.nan, np.inf])
def test_other_thickness_is_refused(X):
    with pytest.raises(OptionError, match="thickness"):
        km.layer(SEVERAL, X)
