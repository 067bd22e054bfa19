"""Gamuts of displays: matrices, Oklab, and laws of each mapping, with a root finder as
the oracle.
"""

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import brentq

from tests.helpers import raises
from uplift.colorimetry import gamut as mapping
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import (
    BLOCK,
    METHODS,
    SRGB,
    Primaries,
    cone_responses,
    conversion,
    cube_roots,
    map_to_gamut,
    oklab,
)
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError, UnknownNameError

P3 = Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.3127, 0.3290))
ACESCG = Primaries((0.713, 0.293), (0.165, 0.830), (0.128, 0.044), (0.32168, 0.33767))
GAMUTS = {"sRGB": SRGB, "P3": P3, "ACEScg": ACESCG}


@pytest.fixture(params=[*GAMUTS, "a cube's"])
def gamut(request):
    """Gamuts of displays by primaries, and of a cube by its sensor."""
    return GAMUTS.get(request.param) or observer.sensor("sRGB", "A")


@pytest.fixture(scope="module")
def outside() -> Array:
    """(n, 3) linear RGB, all outside [0, 1]: slightly, far, too bright, too dark, too
    saturated, and combinations.
    """
    rng = np.random.default_rng(0)
    near = np.clip(rng.normal(0.5, 0.5, (3000, 3)), 0, 1)
    near += rng.normal(0, 1e-3, (3000, 3))
    far = rng.normal(0.5, 1, (4000, 3))
    bright = 20 * rng.random((1000, 3))
    corners = (3 * np.eye(3), -np.eye(3), 2 - 2 * np.eye(3))
    rgb = np.concatenate([near, far, bright, -rng.random((100, 3)), *corners])
    return rgb[((rgb < 0) | (rgb > 1)).any(axis=1)]


MOVERS = [method for method in METHODS if method != "error"]


def test_moved_colours_are_counted_and_rounding_errors_are_none():
    rgb = [[0.2, 1 + 1e-12, -1e-12], [-0.25, 0.5, 1.5], [1.125, 0, 0]]
    found = map_to_gamut(rgb, SRGB, "clip")
    assert found.outside.tolist() == [False, True, True]
    assert (found.count, found.max_change) == (2, 0.5)
    assert_array_equal(found.rgb, np.clip(rgb, 0, 1))
    assert_array_equal(found.requested[1:], rgb[1:])
    assert map_to_gamut(np.zeros((0, 3)), SRGB, "clip").max_change == 0


@pytest.mark.parametrize(
    ("rgb", "method", "error", "code"),
    [
        *(
            ([[0.1, 0.2, 0.3], [2, 0, np.nan]], m, ColourError, "colour")
            for m in METHODS
        ),
        ([2, 0, 0], "error", ColourError, "rgb-out-of-gamut"),
        (0.5, "clip", ColourError, "colour"),
        ([[0.1, 0.2, 0.3], [0.1]], "clip", ColourError, "colour"),
        ([0.1, 0.2, 0.3], "squash", UnknownNameError, "unknown-name"),
    ],
)
def test_bad_input_raises(rgb, method, error, code):
    with raises(error, code):
        map_to_gamut(rgb, SRGB, method)


@pytest.mark.parametrize("method", MOVERS)
def test_answers_do_not_depend_on_precision_or_blocks(method):
    rgb = np.random.default_rng(0).normal(0.5, 1, (BLOCK + 10, 3)).astype(np.float32)
    found, expected = (
        map_to_gamut(each, SRGB, method).rgb for each in (rgb, rgb.astype(float))
    )
    assert found.dtype == np.float32
    assert_allclose(found, expected, rtol=0, atol=1e-7)
    assert_array_equal(
        expected[-20:], map_to_gamut(rgb[-20:].astype(float), SRGB, method).rgb
    )


CIE_RGB = Primaries(
    (0.73467, 0.26533), (0.27376, 0.71741), (0.16658, 0.00886), (1 / 3, 1 / 3)
)
D65 = (0.3127, 0.3290)


def test_example_of_the_thesis():
    """Equations 4.2 and 4.3, whose last printed digit is unreliable: .26553 stands for
    .26533.
    """
    assert_allclose(CIE_RGB.lengths, [0.66694, 1.1324, 1.2006], rtol=0, atol=2e-4)
    printed = [
        [0.48989, 0.31001, 0.20000],
        [0.176696, 0.81240, 0.01064],
        [0, 0.01000, 0.98999],
    ]
    assert_allclose(CIE_RGB.rgb_to_xyz, printed, rtol=0, atol=3e-4)


def test_matrices_agree_with_all_spaces_of_colour_science():
    there = conversion(ACESCG, P3)
    assert_allclose(there @ [1, 1, 1], 1, rtol=0, atol=1e-15)
    assert_allclose(conversion(P3, ACESCG) @ there, np.eye(3), rtol=0, atol=1e-12)
    for space in colour.RGB_COLOURSPACES.data.values():
        ours = Primaries.of([*space.primaries.ravel(), *space.whitepoint])
        theirs = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
        assert_allclose(ours.rgb_to_xyz, theirs, rtol=0, atol=1e-12)
        assert_allclose(ours.rgb_to_xyz.sum(axis=1)[1], 1, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    "numbers",
    [
        (0.6, 0.3, 0.3, 0.6, 0.15, 0.06, 0.7, 0.3),
        (0.6, 0.3, 0.3, 0.3, 0.1, 0.3, *D65),
        (0.6, 0.3, 0.3, 0.6, 0.15, 0.06, 0.3, 0),
        (0.6, 0.3, 0.3, np.inf, 0.15, 0.06, *D65),
        (0.64, 0.33, 0.3, 0.6, 0.15, 0.06),
    ],
)
def test_invalid_primaries_raise(numbers):
    with raises(OptionError, "option"):
        Primaries.of(numbers)


def test_oklab_agrees_with_colour_science(outside):
    """Up to the white: colour-science rounds that of D65 to four digits."""
    theirs = colour.XYZ_to_Oklab(outside @ SRGB.rgb_to_xyz.T)
    assert_allclose(oklab(outside, SRGB), theirs, rtol=0, atol=5e-4)


def luminance(rgb, gamut):
    return rgb @ gamut.rgb_to_xyz[1]


@pytest.mark.parametrize("method", MOVERS)
def test_mapped_colours_are_inside_and_colours_inside_are_unchanged(
    method, gamut, outside
):
    found = map_to_gamut(outside, gamut, method).rgb
    assert ((found >= 0) & (found <= 1)).all()
    corners = np.stack(np.meshgrid([0.0, 1], [0.0, 1], [0.0, 1]), axis=-1).reshape(8, 3)
    for inside in (found, corners, np.random.default_rng(1).random((500, 3))):
        assert_array_equal(map_to_gamut(inside, gamut, method).rgb, inside)


def test_procedure_of_the_thesis_gives_the_same_chromaticity(gamut):
    """6.2.3: the line through white, (⅓, ⅓), in coordinates R / (R + G + B), G / (R + G
    + B) intersects b = 0.
    """
    rgb = np.array([[0.6, 0.35, -0.2], [0.2, 0.5, -0.05], [0.3, 0.31, -0.4]])
    found = map_to_gamut(rgb, gamut, "scale").rgb
    for before, after in zip(rgb, found, strict=True):
        x, y = before[:2] / before.sum()
        slope = (y - 1 / 3) / (x - 1 / 3)
        intercept = 1 / 3 - slope / 3
        met = (1 - intercept) / (1 + slope)
        assert_allclose(after / after.sum(), [met, 1 - met, 0], rtol=0, atol=1e-12)


def scalar_mapping(rgb, gamut, method):
    """Map one colour with a root finder in place of formulas and bisection."""
    light = float(luminance(rgb, gamut))
    if method == "desaturate-oklab":
        lab = oklab(rgb[None], gamut)[0]
        back = np.linalg.inv(cone_responses(gamut))
        lightness = min(max(lab[0], 0), 1)

        def at(share):
            return (
                back
                @ cube_roots(np.array([lightness, share * lab[1], share * lab[2]])) ** 3
            )

        def margin(share):
            found = at(share)
            return min(
                found.min() + mapping.NEARLY * found.max(),
                1 + mapping.NEARLY - found.max(),
            )

        return scalar_mapping(at(_largest(margin)), gamut, "desaturate")
    grey = max(light, 0) if method == "scale" else min(max(light, 0), 1)

    def remaining(share):
        found = grey + share * (rgb - grey)
        return min(found.min(), np.inf if method == "scale" else 1 - found.max())

    inside = grey + _largest(remaining) * (rgb - grey)
    return np.clip(inside / max(inside.max(), 1), 0, 1)


def _largest(margin):
    """Largest share in [0, 1] with a margin of at least 0."""
    return (
        1.0
        if margin(1) >= 0
        else brentq(margin, 0, 1, xtol=1e-14)
        if margin(0) > 0
        else 0.0
    )


@pytest.mark.parametrize("method", ["scale", "desaturate", "desaturate-oklab"])
def test_vectorised_code_agrees_with_scalar_code(method, gamut, outside):
    some = outside[:: len(outside) // 80]
    assert_allclose(
        map_to_gamut(some, gamut, method).rgb,
        [scalar_mapping(rgb, gamut, method) for rgb in some],
        rtol=0,
        atol=1e-6,
    )
