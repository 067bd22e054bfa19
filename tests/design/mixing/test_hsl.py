"""HSL: agreement with the 1979 algorithm and with the standard library."""

from __future__ import annotations

import colorsys

import numpy as np

from uplift.design.mixing import hsl


def core_1979(h, s, l):  # noqa: E741
    """Convert HSL to RGB by the algorithm of 1979 (Fishkin 1983, 5.3.3), in degrees."""

    def value(low, high, hue):
        hue %= 360
        if hue < 60:
            return low + (high - low) * hue / 60
        if hue < 180:
            return high
        if hue < 240:
            return low + (high - low) * (240 - hue) / 60
        return low

    high = l * (1 + s) if l <= 0.5 else l + s - l * s
    low = 2 * l - high
    return [value(low, high, 360 * h + offset) for offset in (120, 0, -120)]


def test_conversion_agrees_with_the_1979_algorithm(rng):
    random = rng.random((2000, 3))
    ends = np.stack(np.meshgrid(np.arange(13) / 12, [0, 0.3, 1], [0, 0.5, 0.7, 1]), axis=-1).reshape(-1, 3)
    for colours in (random, ends):
        expected = [core_1979(*colour) for colour in colours]
        np.testing.assert_allclose(hsl.to_rgb(colours), expected, atol=1e-12)


def test_round_trip(rng):
    rgb = np.concatenate([rng.random((500, 3)), rng.integers(0, 3, (500, 3)) / 2])
    found = hsl.from_rgb(rgb)
    assert ((found >= 0) & (found <= 1)).all()
    np.testing.assert_allclose(hsl.to_rgb(found), rgb, atol=1e-12)
    expected = np.array([colorsys.rgb_to_hls(*one) for one in rgb])[:, [0, 2, 1]]
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_hues_repeat():
    np.testing.assert_allclose(hsl.to_rgb([[-1 / 3, 1, 0.5], [5 / 3, 1, 0.5]]), [[0, 0, 1], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(hsl.to_rgb([-1e-18, 1, 0.5]), [1, 0, 0], atol=1e-12)


def test_images(rng):
    image = rng.random((4, 5, 3))
    assert hsl.to_rgb(image).shape == (4, 5, 3)
    np.testing.assert_array_equal(hsl.to_rgb(image)[2, 3], hsl.to_rgb(image[2, 3]))
