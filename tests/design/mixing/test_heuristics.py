"""Heuristics of Fishkin 1983: HSL as in the standard library, RYB-HSL and phosphor curves."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest

from uplift.design.mixing import heuristics
from uplift.design.mixing.heuristics import RGB_WHEEL, RYB_WHEEL, hsl_to_rgb, mix_ryb, rgb_to_hsl

COLOURS = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0.2, 0.5, 0.3], [0.9, 0.8, 0.7]])


@pytest.fixture(scope="module")
def monitor():
    return heuristics.make_monitor()


def pairs(other):
    return np.stack([COLOURS, np.broadcast_to(other, COLOURS.shape)], axis=1)


def test_shades_keep_their_chromaticity_and_tints_their_hue():
    np.testing.assert_allclose(mix_ryb(pairs(np.zeros(3)), [1, 3]), COLOURS / 4, atol=1e-12)
    np.testing.assert_allclose(mix_ryb(pairs(np.ones(3)), [1, 3]), (COLOURS + 3) / 4, atol=1e-12)


@pytest.mark.parametrize("hue", [0, 0.1, 1 / 6, 0.4, 2 / 3, 0.9])
def test_opposite_hues_mix_to_grey(hue):
    opposite = np.interp((np.interp(hue, RGB_WHEEL, RYB_WHEEL) + 0.5) % 1, RYB_WHEEL, RGB_WHEEL)
    full = hsl_to_rgb([[hue, 1, 0.5], [opposite, 1, 0.5]])
    np.testing.assert_allclose(mix_ryb(full, [1, 1]), 0.5, atol=1e-12)


def test_the_thesis_s_complements():
    """Blue and orange, yellow and purple are opposite; red and green nearly are."""
    blue, orange, yellow, purple = [0, 0, 1], [1, 0.5, 0], [1, 1, 0], [1, 0, 1]
    for pair in ((blue, orange), (yellow, purple)):
        np.testing.assert_allclose(mix_ryb(pair, [1, 1]), 0.5, atol=1e-12)
    assert np.ptp(mix_ryb([[1, 0, 0], [0, 1, 0]], [1, 1])) < 0.2


def test_mixtures_stay_in_gamut(rng):
    found = mix_ryb(rng.random((2000, 3, 3)), rng.random((2000, 3)))
    assert ((found >= 0) & (found <= 1)).all()


def test_a_single_curve_gives_its_own_colour(monitor):
    found = monitor.mix(COLOURS[:, None], np.ones((len(COLOURS), 1)))
    np.testing.assert_allclose(found, COLOURS, atol=1e-12)


def test_filters_do_not_amplify_light(monitor, rng):
    assert monitor.curves.sum(axis=0).max() == pytest.approx(1)
    assert (monitor.curves >= 0).all()
    one, two = (monitor.mix(COLOURS[:, None], np.full((len(COLOURS), 1), x)) for x in (1, 2))
    assert (two.sum(axis=1) < one.sum(axis=1)).all()


def test_the_white_curve_is_not_a_clear_filter(monitor):
    """Impurity of real filters in Fishkin 1983: white on white is darker than white."""
    assert (monitor.mix(np.ones((2, 3)), np.ones(2)) < 0.6).all()


def test_hsl_agrees_with_the_standard_library_and_round_trips(rng):
    rgb = np.concatenate([rng.random((500, 3)), rng.integers(0, 3, (500, 3)) / 2])
    found = rgb_to_hsl(rgb)
    assert ((found >= 0) & (found <= 1)).all()
    np.testing.assert_allclose(hsl_to_rgb(found), rgb, atol=1e-12)
    expected = np.array([colorsys.rgb_to_hls(*one) for one in rgb])[:, [0, 2, 1]]
    np.testing.assert_allclose(found, expected, atol=1e-12)
    ends = np.stack(np.meshgrid(np.arange(13) / 12, [0, 0.3, 1], [0, 0.5, 0.7, 1]), axis=-1).reshape(-1, 3)
    for hsl in (rng.random((2000, 3)), ends):
        expected = [colorsys.hls_to_rgb(hue, lightness, saturation) for hue, saturation, lightness in hsl]
        np.testing.assert_allclose(hsl_to_rgb(hsl), expected, atol=1e-12)


def test_hues_repeat():
    np.testing.assert_allclose(hsl_to_rgb([[-1 / 3, 1, 0.5], [5 / 3, 1, 0.5]]), [[0, 0, 1], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(hsl_to_rgb([-1e-18, 1, 0.5]), [1, 0, 0], atol=1e-12)
