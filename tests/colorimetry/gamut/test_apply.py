"""Input and output of gamut mapping, for every method."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry.gamut import BLOCK, METHODS, SRGB, map_to_gamut
from uplift.common.errors import ColourError, OptionError

MOVERS = [method for method in METHODS if method != "error"]


@pytest.mark.parametrize("shape", [(3,), (0, 3), (2, 3), (2, 5, 3)])
@pytest.mark.parametrize("method", MOVERS)
def test_shapes_are_kept(shape, method):
    rgb = np.full(shape, 0.5)
    rgb[..., 0] = 1.5
    found = map_to_gamut(rgb, SRGB, method)
    assert found.rgb.shape == found.requested.shape == shape
    assert found.outside.shape == shape[:-1]
    assert found.count == rgb.size // 3
    assert found.max_change == pytest.approx(0.5 if rgb.size else 0, rel=1)


def test_result_reports_the_moved_colours():
    found = map_to_gamut([[0.2, 0.3, 0.4], [-0.25, 0.5, 1.5], [1.125, 0, 0]], SRGB, "clip")
    assert found.outside.tolist() == [False, True, True]
    assert (found.count, found.max_change) == (2, 0.5)
    np.testing.assert_array_equal(found.rgb, [[0.2, 0.3, 0.4], [0, 0.5, 1], [1, 0, 0]])
    np.testing.assert_array_equal(found.requested[1], [-0.25, 0.5, 1.5])


@pytest.mark.parametrize("method", METHODS)
def test_rounding_errors_are_in_gamut(method):
    found = map_to_gamut([1 + 1e-12, -1e-12, 0.5], SRGB, method)
    assert found.rgb.tolist() == [1, 0, 0.5]
    assert found.count == 0


@pytest.mark.parametrize("method", MOVERS)
def test_float32_stays_float32_and_gives_the_same_colours(method):
    rgb = np.random.default_rng(0).normal(0.5, 0.6, (50, 3)).astype(np.float32)
    found = map_to_gamut(rgb, SRGB, method).rgb
    assert found.dtype == np.float32
    expected = map_to_gamut(rgb.astype(float), SRGB, method).rgb
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    inside = ((rgb >= 0) & (rgb <= 1)).all(axis=1)
    np.testing.assert_array_equal(found[inside], rgb[inside])


@pytest.mark.parametrize("method", MOVERS)
def test_result_does_not_depend_on_blocks(method):
    rgb = np.random.default_rng(0).normal(0.5, 1, (BLOCK + 10, 3))
    found = map_to_gamut(rgb, SRGB, method).rgb
    np.testing.assert_array_equal(found[-20:], map_to_gamut(rgb[-20:], SRGB, method).rgb)


@pytest.mark.parametrize("method", MOVERS)
@pytest.mark.parametrize("value", [1.7e308, 1e150, 5e-324, 1e-160])
def test_extreme_magnitudes_are_mapped_inside(method, value):
    signs = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 3)
    found = map_to_gamut(value * signs - (value < 1) * np.array([0, 0, 1e-3]), SRGB, method).rgb
    assert np.isfinite(found).all()
    assert found.min() >= 0
    assert found.max() <= 1


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_non_finite_colours_raise(method, bad):
    code = "rgb-out-of-gamut" if method == "error" else "rgb-not-finite"
    with raises(ColourError, code) as caught:
        map_to_gamut([[0.1, 0.2, 0.3], [0.5, 0.5, bad], [2, 0, 0]], SRGB, method)
    assert f"(0.5, 0.5, {bad})" in caught.value.problem


def test_error_quotes_the_first_colour_outside():
    with raises(ColourError, "rgb-out-of-gamut") as caught:
        map_to_gamut([[0.1, 0.2, 0.3], [0.5, 1.5, 0], [2, 0, 0]], SRGB)
    assert "(0.5, 1.5, 0)" in caught.value.problem
    assert "map_to_gamut" in caught.value.hint


@pytest.mark.parametrize(
    ("rgb", "code"),
    [
        (0.5, "rgb-wrong-shape"),
        ([0.1, 0.2], "rgb-wrong-shape"),
        ("red", "rgb-not-numeric"),
        ([["a", "b", "c"]], "rgb-not-numeric"),
        ([[0.1, 0.2, 0.3], [0.1]], "rgb-not-numeric"),
    ],
)
def test_values_that_are_not_colours_raise(rgb, code):
    with raises(ColourError, code):
        map_to_gamut(rgb, SRGB, "clip")


def test_unknown_method_raises():
    with raises(OptionError, "unknown-gamut-mapping") as caught:
        map_to_gamut([0.1, 0.2, 0.3], SRGB, "squash")
    assert "'squash'" in caught.value.problem
    assert "error, clip, scale" in caught.value.hint
