"""Kubelka and Munk's theory: numerical integration, eq. 10.11 as printed, limits; K and S from reflectances."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing import dispersive, pigments
from uplift.design.mixing.pigments import (
    CONSTANT,
    SQUARE_ROOT,
    Pigment,
    PowerOfReflectance,
    from_black_and_white,
    from_opaque,
)

SEVERAL = Pigment(np.array([0.3, 2.0, 0.01]), np.array([1.5, 0.2, 4.0]))
R = np.linspace(pigments.DARKEST, 1, 200)
RULES = [CONSTANT, SQUARE_ROOT, PowerOfReflectance(1.0)]


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
    found = Pigment(np.array([K]), np.array([S])).layer(X)
    assert found.over(ground)[0] == pytest.approx(solved.y[1, 0], abs=1e-8)
    crossed = found.transmittance / (1 - found.reflectance * ground)
    assert crossed[0] == pytest.approx(solved.y[0, -1], abs=1e-8)


@pytest.mark.parametrize("X", [0.01, 1.0, 20.0])
@pytest.mark.parametrize("ground", [0.0, 0.5, 1.0])
def test_reflectance_on_a_ground_follows_kubelka_1948(X, ground):
    expected = printed(SEVERAL.absorption, SEVERAL.scattering, X, ground)
    np.testing.assert_allclose(SEVERAL.layer(X).over(ground), expected)


def test_the_thesis_s_example():
    """10.2.3: K .1 and .3, S .4 and .2, mixed 2:1: S/K = 2 and R = .38."""
    mixture = Pigment(np.array([[0.1], [0.3]]), np.array([[0.4], [0.2]])).mix([2, 1])
    assert mixture.scattering / mixture.absorption == pytest.approx(2)
    assert mixture.opaque_reflectance()[0] == pytest.approx(0.38, abs=0.005)


def test_two_layers_equal_one_of_their_total_thickness(paint):
    for ground in (0.0, 0.3, 1.0):
        both = paint.layer(0.7).over(paint.layer(1.6).over(ground))
        np.testing.assert_allclose(both, paint.layer(2.3).over(ground), rtol=1e-10)


@pytest.mark.parametrize("X", [0.0, 1e-9, 1.0, 1e3, 1e9, 1e300])
def test_energy_is_not_created(paint, X):
    found = paint.layer(X)
    assert (found.reflectance >= 0).all()
    assert (found.transmittance >= 0).all()
    assert (found.reflectance + found.transmittance <= 1 + 1e-12).all()
    assert (found.over(1.0) <= 1 + 1e-12).all()


def test_energy_is_conserved_without_absorption():
    """K → 0: R = SX / (1 + SX), and T = 1 − R."""
    found = Pigment(np.zeros(2), np.array([0.5, 3.0])).layer(2.0)
    np.testing.assert_allclose(found.reflectance, [1 / 2, 6 / 7])
    np.testing.assert_allclose(found.transmittance, [1 / 2, 1 / 7])
    assert found.over(1.0) == pytest.approx(1)


def test_without_scattering_beer_s_law_holds():
    found = Pigment(np.array([0.5, 3.0]), np.zeros(2)).layer(2.0)
    np.testing.assert_allclose(found.transmittance, np.exp([-1, -6]))
    assert not found.reflectance.any()


def test_limits_are_continuous():
    for K, S in (([0, 1e-12], [2, 2]), ([2, 2], [0, 1e-12]), ([0, 1e-13], [0, 1e-13])):
        found = Pigment(np.array(K, float), np.array(S, float)).layer(1.5)
        for values in (found.reflectance, found.transmittance):
            assert values[1] == pytest.approx(values[0], abs=1e-6)


def test_thick_paint_hides_its_ground_and_thickness_0_shows_it(paint):
    opaque = Pigment(paint.absorption[3:], paint.scattering[3:])
    for ground in (0.0, 1.0):
        np.testing.assert_allclose(opaque.layer(1e7).over(ground), opaque.opaque_reflectance(), rtol=1e-9)
    np.testing.assert_array_equal(SEVERAL.layer(0.0).over([0.1, 0.5, 1]), [0.1, 0.5, 1])
    limits = Pigment(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    np.testing.assert_array_equal(limits.opaque_reflectance(), [1, 0, 0])


@pytest.mark.parametrize("X", [-1, np.nan, np.inf])
def test_invalid_thickness_raises(X):
    with raises(OptionError, "invalid-thickness"):
        SEVERAL.layer(X)


def test_amy_is_exact_for_strong_absorption_and_half_for_white():
    """Eq. 10.3 and 10.4 compared with eq. 10.2 and 10.5, and the example of 10.2.2."""
    dark = Pigment(np.array([5.0]), np.array([0.05]))
    np.testing.assert_allclose(dark.amy_opaque_reflectance(), dark.opaque_reflectance(), rtol=1e-3)
    approximate, exact = dark.amy_layer(0.4), dark.layer(0.4)
    np.testing.assert_allclose(approximate.reflectance, exact.reflectance, rtol=1e-3)
    np.testing.assert_allclose(approximate.transmittance, exact.transmittance, rtol=1e-3)
    white = Pigment(np.array([1e-9]), np.array([1.0]))
    assert white.amy_opaque_reflectance() == pytest.approx(0.5)
    assert Pigment(np.array([1 / 6]), np.array([1 / 3])).amy_opaque_reflectance() == pytest.approx(1 / 3)
    assert Pigment(np.zeros(1), np.zeros(1)).amy_opaque_reflectance() == 0


@pytest.mark.parametrize("rule", RULES)
def test_opaque_reflectance_round_trip_alone_and_mixed_with_itself(rule):
    np.testing.assert_allclose(from_opaque(R, rule).opaque_reflectance(), R, rtol=1e-9)
    np.testing.assert_allclose(from_opaque(np.stack([R, R]), rule).mix([3, 2]).opaque_reflectance(), R, rtol=1e-9)


@pytest.mark.parametrize("rule", RULES)
def test_mixtures_lie_between_their_paints(spectra, parts, rule):
    found = from_opaque(spectra, rule).mix(parts).opaque_reflectance()
    paints = np.maximum(spectra, pigments.DARKEST)
    assert (found >= paints.min(axis=1) - 1e-12).all()
    assert (found <= paints.max(axis=1) + 1e-12).all()


def test_two_constants_with_equal_scattering_are_one(spectra, parts):
    """Eq. 10.7 with equal S: K/S of the mixture is the mean of K/S (eq. 10.6)."""
    spectra = np.maximum(spectra, pigments.DARKEST)
    mixture = from_opaque(spectra, CONSTANT).mix(parts)
    ratios = (1 - spectra) ** 2 / (2 * spectra)
    expected = (parts[..., None] * ratios).sum(axis=1) / parts.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(mixture.absorption / mixture.scattering, expected)


def test_two_grounds_determine_k_and_s(paint):
    layer = paint.layer(1.0)
    known = layer.transmittance > 0.02
    assert known.sum() > 30
    found = from_black_and_white(layer.over(0.0)[known], layer.over(1.0)[known])
    np.testing.assert_allclose(found.absorption, paint.absorption[known], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(found.scattering, paint.scattering[known], rtol=1e-6, atol=1e-8)
    dye, white = from_black_and_white([0.0], [0.25]), from_black_and_white([0.5], [1.0])
    assert (dye.absorption, dye.scattering) == (pytest.approx(np.log(2)), 0)
    assert (white.absorption, white.scattering) == (0, pytest.approx(1))


@pytest.mark.parametrize(("on_black", "on_white"), [(0.3, 0.3), (0.5, 0.2), (0.6, 1.3)])
def test_contradictory_reflectances_raise(on_black, on_white):
    with pytest.raises(ColourError):
        from_black_and_white([on_black], [on_white])


def test_grey_paints_scatter_alike_at_all_wavelengths(sensor):
    found = dispersive(sensor)(np.full((2, 81), [[0.2], [1.0]]))
    np.testing.assert_allclose(found, np.full((2, 81), [[0.2**0.75], [1.0]]), rtol=1e-12)


def test_h_is_the_mean_on_one_side_less_that_on_the_other(sensor, rng):
    """The matrix against sums written out."""
    reflectance = rng.uniform(pigments.DARKEST_DISPERSED, 1, 81)
    strength = np.sqrt((1 - reflectance) ** 2 / (2 * reflectance))
    expected = []
    for wavelength in sensor.wavelengths:
        weights = np.exp(-np.abs(sensor.wavelengths - wavelength) / pigments.REACH)
        below, above = (
            sum(w * s for w, s, side in zip(weights, strength, sides, strict=True) if side)
            / sum(w for w, side in zip(weights, sides, strict=True) if side)
            for sides in (sensor.wavelengths <= wavelength, sensor.wavelengths >= wavelength)
        )
        expected.append(below - above)
    Y = (sensor.cmfs[:, 1] * reflectance).sum() / sensor.cmfs[:, 1].sum()
    np.testing.assert_allclose(dispersive(sensor)(reflectance), Y**0.75 * np.exp(np.array(expected) / 4), rtol=1e-12)


def test_further_wavelengths_change_nothing_and_are_consistent(sensor, rng):
    reflectance, assumed = rng.uniform(0.01, 1, (3, 81)), dispersive(sensor)
    columns = [14, 34, 0, 80]
    extended = np.concatenate([reflectance, reflectance[:, columns]], axis=1)
    found = dispersive(sensor, [450.0, 550.0, 300.0, 900.0])(extended)
    np.testing.assert_allclose(found[:, :81], assumed(reflectance), rtol=1e-12)
    np.testing.assert_allclose(found[:, 81:], assumed(reflectance)[:, columns], rtol=1e-12)


def test_scattering_is_finite_and_bounded(sensor):
    extremes = np.stack([np.full(81, 1e-4), np.where(np.arange(81) < 40, 1e-4, 1), np.ones(81)])
    found = dispersive(sensor)(extremes)
    assert (found > 0).all()
    assert found.max() < np.exp(0.25 * 0.99 / np.sqrt(0.02)) + 1e-9
