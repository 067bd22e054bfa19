"""Invariants of each gamut mapping, and vectorised code against scalar code with a root finder."""

from __future__ import annotations

import colorsys

import colour
import numpy as np
import pytest
from scipy.optimize import brentq

from tests.colorimetry.gamut.conftest import GAMUTS
from uplift.colorimetry import gamut as mapping
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, cone_responses, cube_roots, map_to_gamut, oklab

MOVERS = [method for method in METHODS if method != "error"]


def luminance(rgb, gamut):
    return rgb @ gamut.rgb_to_xyz[1]


def chromaticity(rgb, gamut):
    """x, y (…, 2)."""
    xyz = rgb @ gamut.rgb_to_xyz.T
    return xyz[..., :2] / xyz.sum(axis=-1, keepdims=True)


def distance_from_line(before, after, gamut):
    """Distance (n,) of mapped chromaticities from the line between white and the original; whether they are nearer."""
    white = chromaticity(np.ones(3), gamut)
    far, near = chromaticity(before, gamut) - white, chromaticity(after, gamut) - white
    length = np.linalg.norm(far, axis=1)
    along = (near * far).sum(axis=1) / length**2
    return np.abs(near[:, 0] * far[:, 1] - near[:, 1] * far[:, 0]) / length, (along >= -1e-9) & (along <= 1 + 1e-9)


def chromatic(rgb, gamut):
    """Colours with enough luminance and chroma for x, y to be defined."""
    kept = (luminance(rgb, gamut) > 1e-3) & (np.ptp(rgb, axis=1) > 1e-6)
    return rgb[kept & ((rgb @ gamut.rgb_to_xyz.T).sum(axis=1) > 1e-3)]


@pytest.mark.parametrize("method", MOVERS)
def test_mapped_colours_are_inside_and_stay_there(method, gamut, outside):
    found = map_to_gamut(outside, gamut, method).rgb
    assert found.min() >= 0
    assert found.max() <= 1
    assert np.isfinite(found).all()
    np.testing.assert_array_equal(map_to_gamut(found, gamut, method).rgb, found)


@pytest.mark.parametrize("method", MOVERS)
def test_in_gamut_colours_are_unchanged(method, gamut):
    rgb = np.random.default_rng(1).random((500, 3))
    rgb[:8] = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
    np.testing.assert_array_equal(map_to_gamut(rgb, gamut, method).rgb, rgb)


@pytest.mark.parametrize("method", ["desaturate", "scale"])
def test_dominant_wavelength_is_kept(method, gamut, outside):
    before = chromatic(outside, gamut)
    off, nearer = distance_from_line(before, map_to_gamut(before, gamut, method).rgb, gamut)
    assert off.max() < 1e-9
    assert nearer.all()


def test_dominant_wavelength_agrees_with_colour_science(outside):
    before = chromatic(outside, SRGB)[:12]
    after = map_to_gamut(before, SRGB, "desaturate").rgb
    white = chromaticity(np.ones(3), SRGB)
    theirs = [colour.dominant_wavelength(chromaticity(rgb, SRGB), white)[0] for rgb in (before, after)]
    np.testing.assert_allclose(*theirs, rtol=0, atol=1e-6)


def test_desaturating_keeps_luminance(gamut, outside):
    found = luminance(map_to_gamut(outside, gamut, "desaturate").rgb, gamut)
    np.testing.assert_allclose(found, np.clip(luminance(outside, gamut), 0, 1), rtol=0, atol=1e-12)


def test_desaturated_colours_touch_the_boundary(gamut, outside):
    found = map_to_gamut(outside, gamut, "desaturate").rgb
    assert np.minimum(found.min(axis=1), 1 - found.max(axis=1)).max() < 1e-12


def test_scaling_keeps_the_chromaticity_of_bright_colours(gamut):
    bright = np.random.default_rng(2).random((200, 3)) * 9 + 0.01
    bright[:, 0] += 1
    found = map_to_gamut(bright, gamut, "scale").rgb
    np.testing.assert_allclose(found, bright / bright.max(axis=1, keepdims=True), rtol=1e-14)
    apart = chromaticity(map_to_gamut(bright, gamut, "clip").rgb, gamut) - chromaticity(bright, gamut)
    assert np.abs(apart).max() > 0.05


def test_scaling_keeps_the_luminance_of_saturated_colours(gamut):
    rng = np.random.default_rng(3)
    rgb = 0.3 * rng.random((200, 3)) + [0.1, 0.1, -0.4]
    np.testing.assert_allclose(
        luminance(map_to_gamut(rgb, gamut, "scale").rgb, gamut), np.maximum(luminance(rgb, gamut), 0), atol=1e-12
    )


def test_oklab_keeps_hue_and_lightness(gamut, outside):
    before = oklab(outside, gamut)
    after = oklab(map_to_gamut(outside, gamut, "desaturate-oklab").rgb, gamut)
    np.testing.assert_allclose(after[:, 0], np.clip(before[:, 0], 0, 1), rtol=0, atol=3e-3)
    chromatic = (np.hypot(*after[:, 1:].T) > 0.02) & (before[:, 0] > 0) & (before[:, 0] < 1)
    turn = np.arctan2(after[:, 2], after[:, 1]) - np.arctan2(before[:, 2], before[:, 1])
    turn = np.degrees((turn + np.pi) % (2 * np.pi) - np.pi)
    assert chromatic.sum() > 1000
    assert np.abs(turn[chromatic]).max() < 1.8


@pytest.mark.parametrize("method", ["desaturate", "desaturate-oklab"])
def test_extreme_luminances_give_white_and_black(method, gamut):
    grey = np.array([[1.0001] * 3, [7.0] * 3, [-0.0001] * 3, [-7.0] * 3])
    np.testing.assert_allclose(map_to_gamut(grey, gamut, method).rgb, [[1] * 3] * 2 + [[0] * 3] * 2, atol=1e-6)
    bright = np.array([[9.0, 8.0, 2.0]])
    np.testing.assert_allclose(map_to_gamut(bright, gamut, method).rgb, 1, rtol=0, atol=2e-3)


def surface(count):
    """(6 count², 3) colours on the surface of [0, 1]³."""
    u, v = (part.ravel() for part in np.meshgrid(*[np.linspace(0, 1, count)] * 2))
    sides = (np.insert(np.stack([u, v], axis=1), axis, end, axis=1) for axis in range(3) for end in (0.0, 1.0))
    return np.concatenate(list(sides))


def largest_jump(gamut, method, rgb, step):
    """Largest change of a component for random steps."""
    rng = np.random.default_rng(4)
    there = rgb + step * rng.normal(0, 1, rgb.shape)
    return np.abs(map_to_gamut(there, gamut, method).rgb - map_to_gamut(rgb, gamut, method).rgb).max()


@pytest.mark.parametrize("method", MOVERS)
@pytest.mark.parametrize("name", GAMUTS)
def test_mappings_are_continuous(method, name, outside):
    assert largest_jump(GAMUTS[name], method, outside, 1e-6) < 1e-3
    assert largest_jump(GAMUTS[name], method, surface(30), 1e-6) < 0.01


def test_oklab_mapping_without_tolerance_is_discontinuous(monkeypatch):
    monkeypatch.setattr(mapping, "NEARLY", 0)
    assert largest_jump(SRGB, "desaturate-oklab", surface(30), 1e-6) > 0.05


def test_procedure_of_the_thesis_gives_the_same_chromaticity(gamut):
    """6.2.3: the line through white, (⅓, ⅓), in coordinates R / (R + G + B), G / (R + G + B) intersects b = 0."""
    rgb = np.array([[0.6, 0.35, -0.2], [0.2, 0.5, -0.05], [0.3, 0.31, -0.4]])
    found = map_to_gamut(rgb, gamut, "scale").rgb
    for before, after in zip(rgb, found, strict=True):
        x, y = before[:2] / before.sum()
        slope = (y - 1 / 3) / (x - 1 / 3)
        intercept = 1 / 3 - slope / 3
        met = (1 - intercept) / (1 + slope)
        np.testing.assert_allclose(after / after.sum(), [met, 1 - met, 0], rtol=0, atol=1e-12)


def test_clamped_saturation_of_hsv_is_the_chromaticity_of_scaling(gamut, outside):
    """6.2.2 moves along the same line toward white, but keeps the largest component in place of the luminance."""
    some = chromatic(outside, gamut)
    some = some[(some.min(axis=1) < 0) & (some.max(axis=1) > 0.01)][::20]
    clamped = np.array(
        [colorsys.hsv_to_rgb(hue, 1, value) for hue, _, value in (colorsys.rgb_to_hsv(*rgb) for rgb in some)]
    )
    scaled = map_to_gamut(some, gamut, "scale").rgb
    np.testing.assert_allclose(chromaticity(clamped, gamut), chromaticity(scaled, gamut), atol=1e-9)
    np.testing.assert_allclose(clamped.max(axis=1), some.max(axis=1))
    assert np.abs(luminance(clamped, gamut) / luminance(some, gamut) - 1).max() > 0.5


def test_the_compromise_of_ives_abney_and_yule_moves_every_colour():
    """6.2.1: coordinates in a triangle around all chromaticities, here that of ACES2065-1, are shown as sRGB."""
    wide = Primaries((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077), SRGB.white)
    rgb = np.random.default_rng(5).random((2000, 3))
    shown = np.clip(rgb @ (np.linalg.inv(wide.rgb_to_xyz) @ SRGB.rgb_to_xyz).T, 0, 1)
    moved = delta_e_rgb(observer.sensor(), rgb, shown)
    assert 8 < moved.mean() < 9
    assert map_to_gamut(rgb, SRGB, "scale").count == 0


def scalar_mapping(rgb, gamut, method):
    """Map one colour with a root finder in place of formulas and bisection."""
    light = float(luminance(rgb, gamut))
    if method == "desaturate-oklab":
        lab = oklab(rgb[None], gamut)[0]
        back = np.linalg.inv(cone_responses(gamut))
        lightness = min(max(lab[0], 0), 1)

        def at(share):
            return back @ cube_roots(np.array([lightness, share * lab[1], share * lab[2]])) ** 3

        def margin(share):
            found = at(share)
            return min(found.min() + mapping.NEARLY * found.max(), 1 + mapping.NEARLY - found.max())

        return scalar_mapping(at(_largest(margin)), gamut, "desaturate")
    grey = max(light, 0) if method == "scale" else min(max(light, 0), 1)

    def remaining(share):
        found = grey + share * (rgb - grey)
        return min(found.min(), np.inf if method == "scale" else 1 - found.max())

    inside = grey + _largest(remaining) * (rgb - grey)
    return np.clip(inside / max(inside.max(), 1), 0, 1)


def _largest(margin):
    """Largest share in [0, 1] with a margin of at least 0."""
    return 1.0 if margin(1) >= 0 else brentq(margin, 0, 1, xtol=1e-14) if margin(0) > 0 else 0.0


@pytest.mark.parametrize("method", ["scale", "desaturate", "desaturate-oklab"])
def test_vectorised_code_agrees_with_scalar_code(method, gamut, outside):
    some = outside[:: len(outside) // 80]
    np.testing.assert_allclose(
        map_to_gamut(some, gamut, method).rgb, [scalar_mapping(rgb, gamut, method) for rgb in some], rtol=0, atol=1e-6
    )
