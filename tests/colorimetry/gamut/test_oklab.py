"""Oklab against colour-science."""

from __future__ import annotations

import colour
import numpy as np

from tests.colorimetry.gamut.conftest import ACESCG
from uplift.colorimetry.gamut import SRGB, cone_responses, cube_roots, oklab


def test_oklab_agrees_with_colour_science(outside):
    """Up to the white: colour-science rounds that of D65 to four digits."""
    theirs = colour.XYZ_to_Oklab(outside @ SRGB.rgb_to_xyz.T)
    np.testing.assert_allclose(oklab(outside, SRGB), theirs, rtol=0, atol=5e-4)


def test_grey_has_zero_a_and_b_in_every_gamut(gamut):
    grey = np.linspace(0, 1, 11)[:, None].repeat(3, axis=1)
    found = oklab(grey, gamut)
    np.testing.assert_allclose(found[:, 0], np.cbrt(grey[:, 0]), rtol=0, atol=1e-7)
    np.testing.assert_allclose(found[:, 1:], 0, rtol=0, atol=1e-7)


def test_cube_roots_invert_oklab(outside):
    back = cube_roots(oklab(outside, ACESCG)) ** 3 @ np.linalg.inv(cone_responses(ACESCG)).T
    np.testing.assert_allclose(back, outside, rtol=0, atol=1e-10)
