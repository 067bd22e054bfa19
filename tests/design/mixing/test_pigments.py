"""K and S: round trips through reflectance, mixtures, and special cases of the theories."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing import amy, kubelka_munk, pigments
from uplift.design.mixing.pigments import Pigment, from_black_and_white, from_opaque
from uplift.design.mixing.scattering import CONSTANT, SQUARE_ROOT, PowerOfReflectance

R = np.linspace(pigments.DARKEST, 1, 200)
SCATTERINGS = [CONSTANT, SQUARE_ROOT, PowerOfReflectance(1.0)]


@pytest.mark.parametrize("scattering", SCATTERINGS)
def test_opaque_reflectance_round_trip(scattering):
    np.testing.assert_allclose(kubelka_munk.opaque_reflectance(from_opaque(R, scattering)), R, rtol=1e-9)


@pytest.mark.parametrize("scattering", SCATTERINGS)
def test_mixing_with_itself_changes_nothing(scattering):
    twice = from_opaque(np.stack([R, R]), scattering).mix([3, 2])
    np.testing.assert_allclose(kubelka_munk.opaque_reflectance(twice), R, rtol=1e-9)


@pytest.mark.parametrize("scattering", SCATTERINGS)
def test_mixtures_lie_between_their_paints(spectra, parts, scattering):
    found = kubelka_munk.opaque_reflectance(from_opaque(spectra, scattering).mix(parts))
    paints = np.maximum(spectra, pigments.DARKEST)
    assert (found >= paints.min(axis=1) - 1e-12).all()
    assert (found <= paints.max(axis=1) + 1e-12).all()


def test_black_and_white_are_finite():
    found = from_opaque([0.0, 1.0], SQUARE_ROOT)
    assert np.isfinite(found.absorption).all()
    assert found.absorption[1] == 0


def test_two_constants_with_equal_scattering_are_one(spectra, parts):
    """Eq. 10.7 with equal S: K/S of the mixture is the mean of K/S."""
    spectra = np.maximum(spectra, pigments.DARKEST)
    mixture = from_opaque(spectra, CONSTANT).mix(parts)
    expected = sum(
        parts[:, i, None] * pigments.absorption_over_scattering(spectra[:, i]) for i in range(3)
    ) / parts.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(mixture.absorption / mixture.scattering, expected)


def test_the_printed_reflectivity_is_wrong():
    """Eq. 10.6 with 1 − R² in place of (1 − R)² does not invert eq. 10.5."""
    paint = Pigment(np.array([0.5]), np.array([0.7]))
    R = kubelka_munk.opaque_reflectance(paint)
    assert pigments.absorption_over_scattering(R) == pytest.approx(5 / 7)
    assert pytest.approx(5 / 7, rel=0.2) != (1 - R**2) / (2 * R)


@pytest.mark.parametrize("grounds", [(0.0, 1.0), (0.05, 0.85), (0.9, 0.1)])
@pytest.mark.parametrize("thickness", [0.3, 2.0])
def test_two_grounds_determine_k_and_s(paint, grounds, thickness):
    layer = kubelka_munk.layer(paint, thickness)
    known = layer.transmittance > 0.02
    assert known.sum() > 30
    measured = [layer.over(ground)[known] for ground in grounds]
    found = from_black_and_white(*measured, grounds, thickness)
    np.testing.assert_allclose(found.absorption, paint.absorption[known], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(found.scattering, paint.scattering[known], rtol=1e-6, atol=1e-8)


def test_a_pure_dye_and_a_pure_white_on_two_grounds():
    dye = from_black_and_white([0.0], [0.25])
    assert (dye.absorption, dye.scattering) == (pytest.approx(np.log(2)), 0)
    white = from_black_and_white([0.5], [1.0])
    assert (white.absorption, white.scattering) == (0, pytest.approx(1))


def test_contradictory_reflectances_raise():
    with raises(ColourError, "layer-too-opaque"):
        from_black_and_white([0.3], [0.3])
    with raises(ColourError, "layer-too-opaque"):
        from_black_and_white([0.5], [0.2])
    with raises(ColourError, "impossible-paint"):
        from_black_and_white([0.6], [1.3])
    with raises(OptionError, "equal-grounds"):
        from_black_and_white([0.3], [0.5], (0.5, 0.5))
    with raises(OptionError, "invalid-thickness"):
        from_black_and_white([0.3], [0.5], thickness=0)


def test_amy_is_exact_for_strong_absorption_and_half_for_white():
    """Eq. 10.3 and 10.4 compared with eq. 10.2 and 10.5."""
    dark = Pigment(np.array([5.0]), np.array([0.05]))
    np.testing.assert_allclose(amy.opaque_reflectance(dark), kubelka_munk.opaque_reflectance(dark), rtol=1e-3)
    approximate, exact = amy.layer(dark, 0.4), kubelka_munk.layer(dark, 0.4)
    np.testing.assert_allclose(approximate.reflectance, exact.reflectance, rtol=1e-3)
    np.testing.assert_allclose(approximate.transmittance, exact.transmittance, rtol=1e-3)
    white = Pigment(np.array([1e-9]), np.array([1.0]))
    assert amy.opaque_reflectance(white) == pytest.approx(0.5)
    assert kubelka_munk.opaque_reflectance(white) == pytest.approx(1, abs=1e-3)


def test_amy_s_example():
    """10.2.2: K = 1/6 and S = 1/3 give 1/3."""
    assert amy.opaque_reflectance(Pigment(np.array([1 / 6]), np.array([1 / 3]))) == pytest.approx(1 / 3)


def test_amy_without_absorption_and_scattering_is_finite():
    nothing = Pigment(np.zeros(1), np.zeros(1))
    assert amy.opaque_reflectance(nothing) == 0
    assert amy.layer(nothing, 3.0).transmittance == 1
