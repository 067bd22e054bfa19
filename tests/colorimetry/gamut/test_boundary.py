"""Matrices from primaries and white, compared with the figures of Fishkin 1983, chapter 4, and colour-science."""

from __future__ import annotations

import colour
import numpy as np
import pytest

from tests.colorimetry.gamut.conftest import ACESCG, P3
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB, Primaries, conversion
from uplift.common.errors import OptionError

CIE_RGB = Primaries((0.73467, 0.26533), (0.27376, 0.71741), (0.16658, 0.00886), (1 / 3, 1 / 3))
D65 = (0.3127, 0.3290)


def test_example_of_the_thesis():
    """Equations 4.2 and 4.3, whose last printed digit is unreliable: .26553 stands for .26533."""
    np.testing.assert_allclose(CIE_RGB.lengths, [0.66694, 1.1324, 1.2006], rtol=0, atol=2e-4)
    printed = [[0.48989, 0.31001, 0.20000], [0.176696, 0.81240, 0.01064], [0, 0.01000, 0.98999]]
    np.testing.assert_allclose(CIE_RGB.rgb_to_xyz, printed, rtol=0, atol=3e-4)


def test_matrices_agree_with_all_spaces_of_colour_science():
    for space in colour.RGB_COLOURSPACES.data.values():
        ours = Primaries.of([*space.primaries.ravel(), *space.whitepoint])
        theirs = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
        np.testing.assert_allclose(ours.rgb_to_xyz, theirs, rtol=0, atol=1e-12)
        np.testing.assert_allclose(ours.rgb_to_xyz.sum(axis=1)[1], 1, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("source", "name"), [(P3, "P3-D65"), (ACESCG, "ACEScg")])
def test_conversions_agree_with_colour_science(source, name):
    theirs = colour.matrix_RGB_to_RGB(name, "sRGB", chromatic_adaptation_transform="Bradford")
    np.testing.assert_allclose(conversion(source, SRGB), theirs, rtol=0, atol=2e-4)  # of rounded matrices


def test_conversions_keep_white_and_are_invertible():
    there, back = conversion(ACESCG, P3), conversion(P3, ACESCG)
    np.testing.assert_allclose(there @ [1, 1, 1], 1, rtol=0, atol=1e-15)
    np.testing.assert_allclose(back @ there, np.eye(3), rtol=0, atol=1e-12)
    np.testing.assert_allclose(conversion(SRGB, SRGB), np.eye(3), rtol=0, atol=1e-15)


def test_sensor_of_a_cube_is_a_gamut_under_any_light():
    np.testing.assert_allclose(conversion(observer.sensor("sRGB", "A"), SRGB), np.eye(3), rtol=0, atol=3e-4)


@pytest.mark.parametrize(
    "pairs",
    [
        ((0.6, 0.3), (0.3, 0.6), (0.15, 0.06), (0.7, 0.3)),
        ((0.6, 0.3), (0.3, 0.3), (0.1, 0.3), D65),
        ((0.6, 0.3), (0.6, 0.3), (0.15, 0.06), D65),
        ((0.6, 0.3), (0.3, 0.6), (0.15, 0.06), (0.3, 0)),
        ((float("nan"), 0.3), (0.3, 0.6), (0.15, 0.06), D65),
        ((0.6, 0.3), (0.3, float("inf")), (0.15, 0.06), D65),
        ((0.6, 0.3), (0.3, 0.6), (0.15, 0.06), (1e308, 0.3)),
        ((0.6, 0.3), (0.3, 0.6), (0.15, 0.06), (0.3, 1e308)),
    ],
)
def test_invalid_primaries_raise(pairs):
    with raises(OptionError, "invalid-primaries"):
        Primaries(*pairs)


def test_primaries_from_eight_numbers():
    assert Primaries.of([0.64, 0.33, 0.3, 0.6, 0.15, 0.06, *D65]) == SRGB
    assert str(SRGB) == "0.64,0.33 0.3,0.6 0.15,0.06 0.3127,0.329"
    with raises(OptionError, "invalid-primaries"):
        Primaries.of([0.64, 0.33, 0.3, 0.6, 0.15, 0.06])
