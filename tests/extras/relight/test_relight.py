"""Relit colours: laws, a plain counterpart that integrates spectra, and measured atlas
entries.
"""

from dataclasses import replace

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import light, sensor
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError
from uplift.extras.relight.relight import RGB_PRODUCT, relight

LIGHTS = ("D65", "A", "FL11", "HP1")


@pytest.fixture(scope="module")
def picture():
    """Colours of 70 × 3 pixels: more rows than are computed at once; the last row is
    white.
    """
    rgb = np.random.default_rng(7).uniform(0, 1, (70, 3, 3)).astype(np.float32)
    rgb[-1] = 1
    return rgb


@pytest.fixture(scope="module")
def relit(picture, small_cube, plain_cube):
    return relight(
        "noise", picture, {"without atlas": plain_cube, "atlas": small_cube}, LIGHTS
    )


@pytest.mark.parametrize("method", [RGB_PRODUCT, "without atlas", "atlas"])
def test_colours_stay_under_the_light_that_they_refer_to(relit, picture, method):
    assert_allclose(relit.renderings[0].colours[method], picture, atol=2e-4)


def test_spectra_agree_with_plain_integration(relit, picture, small_cube):
    for rendering in relit.renderings:
        screen = sensor("sRGB", rendering.light)
        expected = screen.rgb(small_cube.reflectance(picture))
        assert_allclose(rendering.colours["atlas"], expected, atol=1e-5)


def test_products_multiply_by_the_rgb_of_the_light(relit, picture, sensor):
    product = picture * (sensor.xyz_to_rgb @ light("A").white)
    expected = sensor.xyz(product) @ relit.renderings[1].sensor.xyz_to_rgb.T
    assert_allclose(relit.renderings[1].colours[RGB_PRODUCT], expected, atol=1e-5)


def test_atlas_entries_are_relit_as_measured_where_products_fail(macbeth_cube):
    build = macbeth_cube.data.sensor
    measured = on_grid(read_atlas("macbeth"), build.wavelengths)
    measured = measured[in_unit_cube(build.rgb(measured))]
    rgb = build.rgb(measured)[None].astype(np.float32)
    relit = relight("chart", rgb, {"atlas": macbeth_cube}, ("A", "HP1"))
    for rendering, bounds in zip(relit.renderings, ((0.3, 3), (0.6, 12)), strict=True):
        truth = rendering.sensor.rgb(measured)[None]
        spectra, products = (
            delta_e_rgb(rendering.sensor, truth, rendering.colours[method])
            for method in ("atlas", RGB_PRODUCT)
        )
        assert spectra.max() < bounds[0]
        assert products.mean() > bounds[1]


def test_the_white_of_a_light_is_white_or_has_its_tint(relit):
    for rendering in relit.renderings:
        white = light(rendering.light).white
        tint = colour.XYZ_to_sRGB(white, apply_cctf_encoding=False)
        codes = 255 * colour.cctf_encoding(np.clip(tint / tint.max(), 0, 1))
        for method in relit.methods:
            for balanced, expected in ((True, 255), (False, codes)):
                shown = rendering.screen_codes(method, balanced=balanced)[-1, 0]
                assert_allclose(shown, expected, atol=1.5)


def test_lamps_look_white_but_sodium_and_candles_do_not(small_cube):
    white = ("D65", "A", "FL2", "LED-B3", "LED-RGB1", "2700K")
    grey = np.full((1, 1, 3), 0.5, np.float32)
    relit = relight("grey", grey, {"a": small_cube}, (*white, "HP1", "1900K"))
    balanced = [each.light for each in relit.renderings if each.is_balanced(None)]
    assert balanced == [*white]


def test_differences_of_transparent_pixels_do_not_count(picture, small_cube):
    opacity = np.zeros_like(picture[..., :1])
    opacity[:30] = 1
    cubes = {"atlas": small_cube}
    whole = relight("a", picture, cubes, ("A",), visible=opacity[..., 0] > 0)
    part = relight("a", picture[:30], cubes, ("A",))
    methods = (RGB_PRODUCT, "atlas")
    expected = part.renderings[0].errors(methods)
    assert whole.renderings[0].errors(methods) == pytest.approx(expected, rel=1e-5)


def test_cubes_of_other_spaces_are_refused(picture, small_cube, plain_cube):
    data = replace(plain_cube.data, sensor=sensor("Display P3"))
    cubes = {"a": small_cube, "b": replace(plain_cube, data=data)}
    with raises(OptionError, "cubes-of-different-spaces"):
        relight("x", picture, cubes, ("A",))
