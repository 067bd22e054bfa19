"""Display of linear RGB: sRGB colours exactly, others at their luminance and dominant wavelength."""

from __future__ import annotations

import colour
import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.colorimetry.srgb import decode, encode, to_display_codes


def test_transfer_curve_agrees_with_the_standard_and_is_invertible():
    linear = np.linspace(0, 1, 300)
    np.testing.assert_allclose(encode(linear), colour.models.eotf_inverse_sRGB(linear), rtol=0, atol=1e-6)
    np.testing.assert_allclose(decode(encode(linear)), linear, rtol=0, atol=1e-6)


def test_srgb_codes_are_unchanged(small_cube):
    codes = np.random.default_rng(0).integers(0, 256, (500, 3))
    np.testing.assert_array_equal(to_display_codes(decode(codes / 255), SRGB), codes)
    of_cube = to_display_codes(small_cube.decode(codes), small_cube.data.sensor)  # its white is that of D65 at 5 nm
    assert np.abs(of_cube - codes).max() <= 1
    assert (of_cube == codes).mean() > 0.98


@pytest.mark.parametrize(("space", "illuminant"), [("P3-D65", "D65"), ("ProPhoto RGB", "D50"), ("sRGB", "A")])
def test_other_spaces_keep_their_appearance(space, illuminant):
    """An sRGB sensor under the illuminant of the cube adapts by Bradford's transform too."""
    own, screen = (observer.sensor(name, illuminant) for name in (space, "sRGB"))
    rgb = 0.3 + 0.3 * np.random.default_rng(1).random((200, 3))  # pale enough for sRGB
    expected = 255 * encode(own.xyz(rgb) @ screen.xyz_to_rgb.T)
    assert np.abs(to_display_codes(rgb, own) - expected).max() < 0.6
    np.testing.assert_array_equal(to_display_codes([1, 1, 1], own), [255, 255, 255])


def test_colours_outside_srgb_keep_their_luminance():
    wide = observer.sensor("P3-D65")
    red = np.array([0.6, 0, 0])
    linear = wide.xyz(red) @ np.linalg.inv(SRGB.rgb_to_xyz).T
    assert linear.min() < -0.01
    codes = to_display_codes(red, wide)
    light = decode(codes / 255) @ SRGB.rgb_to_xyz[1]
    assert light == pytest.approx(wide.xyz(red)[1], abs=2e-3)
    clipped = decode(np.rint(255 * encode(linear)) / 255) @ SRGB.rgb_to_xyz[1]
    assert abs(clipped - wide.xyz(red)[1]) > 5e-3
    np.testing.assert_array_equal(codes, np.rint(255 * encode(map_to_gamut(linear, SRGB, "desaturate").rgb)))
