"""What goes in and what comes out, whatever the way."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.gamut import METHODS, SRGB, map_to_gamut
from uplift.colorimetry.gamut.apply import BLOCK
from uplift.common.errors import ColourError, OptionError

MOVERS = [way for way in METHODS if way != "error"]


def test_the_command_line_offers_what_there_is():
    import click
    from uplift_cli.params.options import out_of_gamut_option

    @click.command()
    @out_of_gamut_option()
    def command(way):
        pass

    (option,) = command.params
    assert tuple(option.type.choices) == METHODS


@pytest.mark.parametrize("shape", [(3,), (0, 3), (2, 3), (2, 5, 3)])
@pytest.mark.parametrize("way", MOVERS)
def test_shapes_stay(shape, way):
    rgb = np.full(shape, 0.5)
    rgb[..., 0] = 1.5
    found = map_to_gamut(rgb, SRGB, way)
    assert found.rgb.shape == found.asked.shape == shape
    assert found.outside.shape == shape[:-1]
    assert found.count == rgb.size // 3
    assert found.farthest == pytest.approx(0.5 if rgb.size else 0, rel=1)


def test_what_was_moved_is_told():
    found = map_to_gamut([[0.2, 0.3, 0.4], [-0.25, 0.5, 1.5], [1.125, 0, 0]], SRGB, "clip")
    assert found.outside.tolist() == [False, True, True]
    assert (found.count, found.farthest) == (2, 0.5)
    np.testing.assert_array_equal(found.rgb, [[0.2, 0.3, 0.4], [0, 0.5, 1], [1, 0, 0]])
    np.testing.assert_array_equal(found.asked[1], [-0.25, 0.5, 1.5])


@pytest.mark.parametrize("way", METHODS)
def test_rounding_takes_nothing_outside(way):
    found = map_to_gamut([1 + 1e-12, -1e-12, 0.5], SRGB, way)
    assert found.rgb.tolist() == [1, 0, 0.5]
    assert found.count == 0


@pytest.mark.parametrize("way", MOVERS)
def test_float32_stays_float32_and_is_moved_alike(way):
    rgb = np.random.default_rng(0).normal(0.5, 0.6, (50, 3)).astype(np.float32)
    found = map_to_gamut(rgb, SRGB, way).rgb
    assert found.dtype == np.float32
    expected = map_to_gamut(rgb.astype(float), SRGB, way).rgb
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    inside = ((rgb >= 0) & (rgb <= 1)).all(axis=1)
    np.testing.assert_array_equal(found[inside], rgb[inside])


@pytest.mark.parametrize("way", MOVERS)
def test_blocks_do_not_show(way):
    rgb = np.random.default_rng(0).normal(0.5, 1, (BLOCK + 10, 3))
    found = map_to_gamut(rgb, SRGB, way).rgb
    np.testing.assert_array_equal(found[-20:], map_to_gamut(rgb[-20:], SRGB, way).rgb)


@pytest.mark.parametrize("way", MOVERS)
@pytest.mark.parametrize("value", [1.7e308, 1e150, 5e-324, 1e-160])
def test_numbers_without_measure(way, value):
    signs = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 3)
    found = map_to_gamut(value * signs - (value < 1) * np.array([0, 0, 1e-3]), SRGB, way).rgb
    assert np.isfinite(found).all()
    assert found.min() >= 0
    assert found.max() <= 1


@pytest.mark.parametrize("way", METHODS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_refused(way, bad):
    with pytest.raises(ColourError, match=r"\(0.5, 0.5, (nan|-?inf)\) (is not finite|lies outside)"):
        map_to_gamut([[0.1, 0.2, 0.3], [0.5, 0.5, bad], [2, 0, 0]], SRGB, way)


def test_error_quotes_the_first():
    with pytest.raises(ColourError, match=r"\(0.5, 1.5, 0\) lies outside \[0, 1\]; .*--out-of-gamut"):
        map_to_gamut([[0.1, 0.2, 0.3], [0.5, 1.5, 0], [2, 0, 0]], SRGB)


@pytest.mark.parametrize("rgb", [0.5, [0.1, 0.2], "red", [["a", "b", "c"]], [[0.1, 0.2, 0.3], [0.1]]])
def test_what_is_no_colour_is_refused(rgb):
    with pytest.raises(ColourError, match="a colour is three numbers"):
        map_to_gamut(rgb, SRGB, "clip")


def test_unknown_ways_are_refused():
    with pytest.raises(OptionError, match="unknown way out of gamut 'squash'; use one of error, clip, scale"):
        map_to_gamut([0.1, 0.2, 0.3], SRGB, "squash")
