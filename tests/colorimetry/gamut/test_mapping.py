"""What each way keeps, and what it gives up; vectorised code against plain code, a colour at a time."""

from __future__ import annotations

import colour
import numpy as np
import pytest
from scipy.optimize import brentq

from tests.colorimetry.gamut.conftest import GAMUTS
from uplift.colorimetry.gamut import METHODS, SRGB, map_to_gamut, mapping
from uplift.colorimetry.gamut.oklab import oklab, responses, roots

MOVERS = [way for way in METHODS if way != "error"]


def luminance(rgb, gamut):
    return rgb @ gamut.rgb_to_xyz[1]


def chromaticity(rgb, gamut):
    """x, y (…, 2)."""
    xyz = rgb @ gamut.rgb_to_xyz.T
    return xyz[..., :2] / xyz.sum(axis=-1, keepdims=True)


def off_the_line(before, after, gamut):
    """How far (n,) chromaticities lie from the line between white and what they were; and whether they are nearer."""
    white = chromaticity(np.ones(3), gamut)
    far, near = chromaticity(before, gamut) - white, chromaticity(after, gamut) - white
    length = np.linalg.norm(far, axis=1)
    along = (near * far).sum(axis=1) / length**2
    return np.abs(near[:, 0] * far[:, 1] - near[:, 1] * far[:, 0]) / length, (along >= -1e-9) & (
        along <= 1 + 1e-9
    )


def lit(rgb, gamut):
    """Colours with light and a hue: x, y are of use."""
    kept = (luminance(rgb, gamut) > 1e-3) & (np.ptp(rgb, axis=1) > 1e-6)
    return rgb[kept & ((rgb @ gamut.rgb_to_xyz.T).sum(axis=1) > 1e-3)]


@pytest.mark.parametrize("way", MOVERS)
def test_all_end_inside_where_they_stay(way, gamut, outside):
    found = map_to_gamut(outside, gamut, way).rgb
    assert found.min() >= 0
    assert found.max() <= 1
    assert np.isfinite(found).all()
    np.testing.assert_array_equal(map_to_gamut(found, gamut, way).rgb, found)


@pytest.mark.parametrize("way", MOVERS)
def test_colours_inside_stay_to_the_bit(way, gamut):
    rgb = np.random.default_rng(1).random((500, 3))
    rgb[:8] = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
    np.testing.assert_array_equal(map_to_gamut(rgb, gamut, way).rgb, rgb)


@pytest.mark.parametrize("way", ["desaturate", "scale"])
def test_the_dominant_wavelength_stays(way, gamut, outside):
    before = lit(outside, gamut)
    off, nearer = off_the_line(before, map_to_gamut(before, gamut, way).rgb, gamut)
    assert off.max() < 1e-9
    assert nearer.all()


@pytest.mark.parametrize("way", ["clip", "desaturate-oklab"])
def test_the_others_leave_the_line(way, gamut, outside):
    before = lit(outside, gamut)
    after = map_to_gamut(before, gamut, way).rgb
    kept = after.any(axis=1)
    off, _ = off_the_line(before[kept], after[kept], gamut)
    assert off.max() > 1e-2


def test_the_dominant_wavelength_is_colour_science_s(outside):
    before = lit(outside, SRGB)[:12]
    after = map_to_gamut(before, SRGB, "desaturate").rgb
    white = chromaticity(np.ones(3), SRGB)
    theirs = [colour.dominant_wavelength(chromaticity(rgb, SRGB), white)[0] for rgb in (before, after)]
    np.testing.assert_allclose(*theirs, rtol=0, atol=1e-6)


def test_desaturating_keeps_luminance(gamut, outside):
    found = luminance(map_to_gamut(outside, gamut, "desaturate").rgb, gamut)
    np.testing.assert_allclose(found, np.clip(luminance(outside, gamut), 0, 1), rtol=0, atol=1e-12)


@pytest.mark.parametrize("way", ["clip", "scale", "desaturate-oklab"])
def test_the_others_do_not(way, outside):
    found = luminance(map_to_gamut(outside, SRGB, way).rgb, SRGB)
    assert np.abs(found - np.clip(luminance(outside, SRGB), 0, 1)).max() > 0.1


def test_no_more_saturation_goes_than_must(gamut, outside):
    found = map_to_gamut(outside, gamut, "desaturate").rgb
    assert np.minimum(found.min(axis=1), 1 - found.max(axis=1)).max() < 1e-12


def test_scaling_keeps_the_chromaticity_of_what_is_too_bright(gamut):
    bright = np.random.default_rng(2).random((200, 3)) * 9 + 0.01
    bright[:, 0] += 1
    found = map_to_gamut(bright, gamut, "scale").rgb
    np.testing.assert_allclose(found, bright / bright.max(axis=1, keepdims=True), rtol=1e-14)
    apart = chromaticity(map_to_gamut(bright, gamut, "clip").rgb, gamut) - chromaticity(bright, gamut)
    assert np.abs(apart).max() > 0.05


def test_scaling_keeps_the_luminance_of_what_is_only_too_saturated(gamut):
    rng = np.random.default_rng(3)
    rgb = 0.3 * rng.random((200, 3)) + [0.1, 0.1, -0.4]
    np.testing.assert_allclose(
        luminance(map_to_gamut(rgb, gamut, "scale").rgb, gamut),
        np.maximum(luminance(rgb, gamut), 0),
        atol=1e-12,
    )


def test_oklab_keeps_hue_and_lightness(gamut, outside):
    before = oklab(outside, gamut)
    after = oklab(map_to_gamut(outside, gamut, "desaturate-oklab").rgb, gamut)
    np.testing.assert_allclose(after[:, 0], np.clip(before[:, 0], 0, 1), rtol=0, atol=3e-3)
    seen = (np.hypot(*after[:, 1:].T) > 0.02) & (before[:, 0] > 0) & (before[:, 0] < 1)
    turn = np.arctan2(after[:, 2], after[:, 1]) - np.arctan2(before[:, 2], before[:, 1])
    turn = np.degrees((turn + np.pi) % (2 * np.pi) - np.pi)
    assert seen.sum() > 1000
    assert np.abs(turn[seen]).max() < 1.8


def test_dominant_wavelengths_do_not_keep_oklab_s_hue(outside):
    """Else the two ways would be one."""
    blue = np.array([[-0.2, 0, 1.0]])
    hues = [
        np.degrees(np.arctan2(*oklab(map_to_gamut(blue, SRGB, way).rgb, SRGB)[0, :0:-1]))
        for way in ("desaturate", "desaturate-oklab")
    ]
    assert abs(hues[0] - hues[1]) > 5


@pytest.mark.parametrize("way", ["desaturate", "desaturate-oklab"])
def test_white_and_black_are_where_the_light_ends(way, gamut):
    grey = np.array([[1.0001] * 3, [7.0] * 3, [-0.0001] * 3, [-7.0] * 3])
    np.testing.assert_allclose(map_to_gamut(grey, gamut, way).rgb, [[1] * 3] * 2 + [[0] * 3] * 2, atol=1e-6)
    bright = np.array([[9.0, 8.0, 2.0]])
    np.testing.assert_allclose(map_to_gamut(bright, gamut, way).rgb, 1, rtol=0, atol=2e-3)


def surface(count):
    """(6 count², 3) colours all over the surface of [0, 1]³."""
    u, v = (part.ravel() for part in np.meshgrid(*[np.linspace(0, 1, count)] * 2))
    sides = (
        np.insert(np.stack([u, v], axis=1), axis, end, axis=1) for axis in range(3) for end in (0.0, 1.0)
    )
    return np.concatenate(list(sides))


def leap(gamut, way, rgb, step):
    """The largest change of a component for random steps."""
    rng = np.random.default_rng(4)
    there = rgb + step * rng.normal(0, 1, rgb.shape)
    return np.abs(map_to_gamut(there, gamut, way).rgb - map_to_gamut(rgb, gamut, way).rgb).max()


@pytest.mark.parametrize("way", MOVERS)
@pytest.mark.parametrize("name", GAMUTS)
def test_nothing_leaps(way, name, outside):
    assert leap(GAMUTS[name], way, outside, 1e-6) < 1e-3
    assert leap(GAMUTS[name], way, surface(30), 1e-6) < 0.01


def test_without_nearly_oklab_would_leap(monkeypatch):
    monkeypatch.setattr(mapping, "NEARLY", 0)
    assert leap(SRGB, "desaturate-oklab", surface(30), 1e-6) > 0.05


def test_the_thesis_s_own_procedure_finds_the_same_chromaticity(gamut):
    """6.2.3: in coordinates of which R, G and B are shares of their sum, white being (⅓, ⅓), b = 0 is met."""
    rgb = np.array([[0.6, 0.35, -0.2], [0.2, 0.5, -0.05], [0.3, 0.31, -0.4]])
    found = map_to_gamut(rgb, gamut, "scale").rgb
    for before, after in zip(rgb, found, strict=True):
        x, y = before[:2] / before.sum()
        slope = (y - 1 / 3) / (x - 1 / 3)
        intercept = 1 / 3 - slope / 3
        met = (1 - intercept) / (1 + slope)
        np.testing.assert_allclose(after / after.sum(), [met, 1 - met, 0], rtol=0, atol=1e-12)


def plain(rgb, gamut, way):
    """One colour, with a root finder in place of formulas and halving."""
    light = float(luminance(rgb, gamut))
    if way == "desaturate-oklab":
        lab = oklab(rgb[None], gamut)[0]
        back = np.linalg.inv(responses(gamut))
        lightness = min(max(lab[0], 0), 1)

        def at(share):
            return back @ roots(np.array([lightness, share * lab[1], share * lab[2]])) ** 3

        def room(share):
            found = at(share)
            return min(found.min() + mapping.NEARLY * found.max(), 1 + mapping.NEARLY - found.max())

        return plain(at(_largest(room)), gamut, "desaturate")
    grey = max(light, 0) if way == "scale" else min(max(light, 0), 1)

    def left(share):
        found = grey + share * (rgb - grey)
        return min(found.min(), np.inf if way == "scale" else 1 - found.max())

    inside = grey + _largest(left) * (rgb - grey)
    return np.clip(inside / max(inside.max(), 1), 0, 1)


def _largest(room):
    """The largest share in [0, 1] that there is room for."""
    return 1.0 if room(1) >= 0 else brentq(room, 0, 1, xtol=1e-14) if room(0) > 0 else 0.0


@pytest.mark.parametrize("way", ["scale", "desaturate", "desaturate-oklab"])
def test_one_colour_at_a_time(way, gamut, outside):
    some = outside[:: len(outside) // 80]
    np.testing.assert_allclose(
        map_to_gamut(some, gamut, way).rgb, [plain(rgb, gamut, way) for rgb in some], rtol=0, atol=1e-6
    )
