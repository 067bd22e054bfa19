"""K and S: from reflectances and back, mixed, and how theories reduce to one another."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing import amy, kubelka_munk, pigments
from uplift.design.mixing.pigments import Pigment, of_hiding, on_two_grounds

R = np.linspace(pigments.DARKEST, 1, 200)
GRADINGS = [0, 0.5, 1]


@pytest.mark.parametrize("grading", GRADINGS)
def test_the_reflectance_comes_back(grading):
    np.testing.assert_allclose(kubelka_munk.hiding(of_hiding(R, grading)), R, rtol=1e-9)


@pytest.mark.parametrize("grading", GRADINGS)
def test_mixing_with_itself_changes_nothing(grading):
    twice = of_hiding(np.stack([R, R]), grading).mixed([3, 2])
    np.testing.assert_allclose(kubelka_munk.hiding(twice), R, rtol=1e-9)


@pytest.mark.parametrize("grading", GRADINGS)
def test_mixtures_lie_between_their_paints(spectra, parts, grading):
    found = kubelka_munk.hiding(of_hiding(spectra, grading).mixed(parts))
    paints = np.maximum(spectra, pigments.DARKEST)
    assert (found >= paints.min(axis=1) - 1e-12).all()
    assert (found <= paints.max(axis=1) + 1e-12).all()


def test_black_and_white_are_finite():
    found = of_hiding([0.0, 1.0])
    assert np.isfinite(found.absorption).all()
    assert found.absorption[1] == 0


def test_two_constants_with_equal_scattering_are_one(spectra, parts):
    """(10.7) with S the same in all paints: K/S of the mixture is the mean of K/S."""
    spectra = np.maximum(spectra, pigments.DARKEST)
    mixture = of_hiding(spectra, 0).mixed(parts)
    expected = sum(
        parts[:, i, None] * pigments.absorption_over_scattering(spectra[:, i]) for i in range(3)
    ) / parts.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(mixture.absorption / mixture.scattering, expected)


def test_the_printed_reflectivity_would_be_noticed():
    """(10.6) with 1 − R² in place of (1 − R)² does not turn (10.5) round."""
    paint = Pigment(np.array([0.5]), np.array([0.7]))
    seen = kubelka_munk.hiding(paint)
    assert pigments.absorption_over_scattering(seen) == pytest.approx(5 / 7)
    assert (1 - seen**2) / (2 * seen) != pytest.approx(5 / 7, rel=0.2)


@pytest.mark.parametrize("grounds", [(0.0, 1.0), (0.05, 0.85), (0.9, 0.1)])
@pytest.mark.parametrize("thickness", [0.3, 2.0])
def test_two_grounds_tell_k_and_s(paint, grounds, thickness):
    layer = kubelka_munk.layer(paint, thickness)
    known = layer.transmittance > 0.02
    assert known.sum() > 30
    seen = [layer.over(ground)[known] for ground in grounds]
    found = on_two_grounds(*seen, grounds, thickness)
    np.testing.assert_allclose(found.absorption, paint.absorption[known], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(found.scattering, paint.scattering[known], rtol=1e-6, atol=1e-8)


def test_a_pure_dye_and_a_pure_white_on_two_grounds():
    dye = on_two_grounds([0.0], [0.25])
    assert (dye.absorption, dye.scattering) == (pytest.approx(np.log(2)), 0)
    white = on_two_grounds([0.5], [1.0])
    assert (white.absorption, white.scattering) == (0, pytest.approx(1))


def test_contradictions_are_refused():
    with pytest.raises(ColourError, match="hides the ground"):
        on_two_grounds([0.3], [0.3])
    with pytest.raises(ColourError, match="hides the ground, or is lighter"):
        on_two_grounds([0.5], [0.2])
    with pytest.raises(ColourError, match="no paint has these"):
        on_two_grounds([0.6], [1.3])
    with pytest.raises(OptionError, match="two grounds"):
        on_two_grounds([0.3], [0.5], (0.5, 0.5))
    with pytest.raises(OptionError, match="some paint"):
        on_two_grounds([0.3], [0.5], thickness=0)


def test_amy_is_right_for_strong_absorption_and_half_for_white():
    """(10.3), (10.4) against (10.2), (10.5)."""
    dark = Pigment(np.array([5.0]), np.array([0.05]))
    np.testing.assert_allclose(amy.hiding(dark), kubelka_munk.hiding(dark), rtol=1e-3)
    approximate, exact = amy.layer(dark, 0.4), kubelka_munk.layer(dark, 0.4)
    np.testing.assert_allclose(approximate.reflectance, exact.reflectance, rtol=1e-3)
    np.testing.assert_allclose(approximate.transmittance, exact.transmittance, rtol=1e-3)
    white = Pigment(np.array([1e-9]), np.array([1.0]))
    assert amy.hiding(white) == pytest.approx(0.5)
    assert kubelka_munk.hiding(white) == pytest.approx(1, abs=1e-3)


def test_amy_s_example():
    """10.2.2: K = 1/6 and S = 1/3 give 1/3."""
    assert amy.hiding(Pigment(np.array([1 / 6]), np.array([1 / 3]))) == pytest.approx(1 / 3)


def test_amy_of_nothing_is_finite():
    nothing = Pigment(np.zeros(1), np.zeros(1))
    assert amy.hiding(nothing) == 0
    assert amy.layer(nothing, 3.0).transmittance == 1
