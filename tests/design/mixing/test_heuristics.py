"""The thesis's heuristics: RYB-HSL and the phosphors' curves."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import UnknownNameError
from uplift.design.mixing import hsl, phosphors, ryb

COLOURS = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0.2, 0.5, 0.3], [0.9, 0.8, 0.7]])


@pytest.fixture(scope="module")
def monitor():
    return phosphors.monitor()


def pairs(other):
    return np.stack([COLOURS, np.broadcast_to(other, COLOURS.shape)], axis=1)


def test_paint_mixed_with_itself_does_not_change():
    np.testing.assert_allclose(ryb.mixed(np.stack([COLOURS] * 2, axis=1), [3, 1]), COLOURS, atol=1e-12)


def test_shades_keep_their_chromaticity_and_tints_their_hue():
    np.testing.assert_allclose(ryb.mixed(pairs(np.zeros(3)), [1, 3]), COLOURS / 4, atol=1e-12)
    np.testing.assert_allclose(ryb.mixed(pairs(np.ones(3)), [1, 3]), (COLOURS + 3) / 4, atol=1e-12)


@pytest.mark.parametrize("hue", [0, 0.1, 1 / 6, 0.4, 2 / 3, 0.9])
def test_opposite_on_the_wheel_is_grey(hue):
    around = np.interp((np.interp(hue, ryb.RGB_WHEEL, ryb.RYB_WHEEL) + 0.5) % 1, ryb.RYB_WHEEL, ryb.RGB_WHEEL)
    full = hsl.to_rgb([[hue, 1, 0.5], [around, 1, 0.5]])
    np.testing.assert_allclose(ryb.mixed(full, [1, 1]), 0.5, atol=1e-12)


def test_the_thesis_s_complements():
    """Blue and orange, yellow and purple are opposite; red and green nearly are."""
    blue, orange, yellow, purple = [0, 0, 1], [1, 0.5, 0], [1, 1, 0], [1, 0, 1]
    for pair in ((blue, orange), (yellow, purple)):
        np.testing.assert_allclose(ryb.mixed(pair, [1, 1]), 0.5, atol=1e-12)
    assert np.ptp(ryb.mixed([[1, 0, 0], [0, 1, 0]], [1, 1])) < 0.2


def test_blue_and_yellow_are_green():
    red, green, blue = ryb.mixed([[0, 0, 1], [1, 1, 0]], [1, 1])
    assert green > max(red, blue)


def test_the_printed_hue_map_has_no_inverse():
    """With the sign mended it still ends at 7/12, from where blue leaps to 2/3."""
    assert pytest.approx(7 / 12) == (2 / 3 - 1 / 6) / 2 + 1 / 3
    assert (np.diff(ryb.RYB_WHEEL) > 0).all()


def test_mixtures_stay_in_the_space(rng):
    found = ryb.mixed(rng.random((2000, 3, 3)), rng.random((2000, 3)))
    assert ((found >= 0) & (found <= 1)).all()


def test_the_monitor_shows_a_curve_as_the_colour_it_is_of(monitor):
    found = monitor.filtered(COLOURS[:, None], np.ones((len(COLOURS), 1)))
    np.testing.assert_allclose(found, COLOURS, atol=1e-12)


def test_the_monitor_makes_no_light(monitor, rng):
    assert monitor.curves.sum(axis=0).max() == pytest.approx(1)
    assert (monitor.curves >= 0).all()
    one, two = (monitor.filtered(COLOURS[:, None], np.full((len(COLOURS), 1), x)) for x in (1, 2))
    assert (two.sum(axis=1) < one.sum(axis=1)).all()


def test_the_monitor_s_white_is_no_clear_filter(monitor):
    """What the thesis calls the impurities of real filters: white and white is darker than white."""
    assert (monitor.filtered(np.ones((2, 3)), np.ones(2)) < 0.6).all()


def test_an_unknown_monitor_is_refused():
    with pytest.raises(UnknownNameError, match="Typical CRT Brainard 1997"):
        phosphors.monitor("Typical CRT")
