"""Heuristics of Fishkin 1983: RYB-HSL and phosphor curves."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import UnknownNameError
from uplift.design.mixing import hsl, phosphors, ryb

COLOURS = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0.2, 0.5, 0.3], [0.9, 0.8, 0.7]])


@pytest.fixture(scope="module")
def monitor():
    return phosphors.make_monitor()


def pairs(other):
    return np.stack([COLOURS, np.broadcast_to(other, COLOURS.shape)], axis=1)


def test_paint_mixed_with_itself_does_not_change():
    np.testing.assert_allclose(ryb.mix(np.stack([COLOURS] * 2, axis=1), [3, 1]), COLOURS, atol=1e-12)


def test_shades_keep_their_chromaticity_and_tints_their_hue():
    np.testing.assert_allclose(ryb.mix(pairs(np.zeros(3)), [1, 3]), COLOURS / 4, atol=1e-12)
    np.testing.assert_allclose(ryb.mix(pairs(np.ones(3)), [1, 3]), (COLOURS + 3) / 4, atol=1e-12)


@pytest.mark.parametrize("hue", [0, 0.1, 1 / 6, 0.4, 2 / 3, 0.9])
def test_opposite_hues_mix_to_grey(hue):
    opposite = np.interp((np.interp(hue, ryb.RGB_WHEEL, ryb.RYB_WHEEL) + 0.5) % 1, ryb.RYB_WHEEL, ryb.RGB_WHEEL)
    full = hsl.to_rgb([[hue, 1, 0.5], [opposite, 1, 0.5]])
    np.testing.assert_allclose(ryb.mix(full, [1, 1]), 0.5, atol=1e-12)


def test_the_thesis_s_complements():
    """Blue and orange, yellow and purple are opposite; red and green nearly are."""
    blue, orange, yellow, purple = [0, 0, 1], [1, 0.5, 0], [1, 1, 0], [1, 0, 1]
    for pair in ((blue, orange), (yellow, purple)):
        np.testing.assert_allclose(ryb.mix(pair, [1, 1]), 0.5, atol=1e-12)
    assert np.ptp(ryb.mix([[1, 0, 0], [0, 1, 0]], [1, 1])) < 0.2


def test_blue_and_yellow_are_green():
    red, green, blue = ryb.mix([[0, 0, 1], [1, 1, 0]], [1, 1])
    assert green > max(red, blue)


def test_the_printed_hue_map_has_no_inverse():
    """With the sign corrected it still ends at 7/12 and jumps to 2/3 at blue."""
    assert pytest.approx(7 / 12) == (2 / 3 - 1 / 6) / 2 + 1 / 3
    assert (np.diff(ryb.RYB_WHEEL) > 0).all()


def test_mixtures_stay_in_gamut(rng):
    found = ryb.mix(rng.random((2000, 3, 3)), rng.random((2000, 3)))
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


def test_an_unknown_monitor_raises():
    with raises(UnknownNameError, "unknown-display") as caught:
        phosphors.make_monitor("Typical CRT")
    assert "Typical CRT Brainard 1997" in caught.value.hint
