"""Relit colours: laws, a plain counterpart that integrates spectra, and measured atlas
entries.
"""

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import write_image
from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import light, sensor
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError
from uplift.extras.images.picture import read_picture
from uplift.extras.relight.relight import RGB_PRODUCT, relight, write_relit_sheet

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
    lamp = light("A").white
    product = picture * (sensor.xyz_to_rgb @ lamp)
    xyz = sensor.xyz(product)
    expected = xyz @ relit.renderings[1].sensor.xyz_to_rgb.T
    assert_allclose(relit.renderings[1].colours[RGB_PRODUCT], expected, atol=1e-5)


def test_atlas_entries_are_relit_as_measured_where_products_fail(macbeth_cube):
    atlas = read_atlas("macbeth")
    build = macbeth_cube.data.sensor
    measured = on_grid(atlas, build.wavelengths)
    rgb = build.rgb(measured)
    inside = in_unit_cube(rgb)
    relit = relight(
        "chart",
        rgb[inside][None].astype(np.float32),
        {"atlas": macbeth_cube},
        ("A", "HP1"),
    )
    for rendering, bounds in zip(relit.renderings, ((0.3, 3), (0.6, 12)), strict=True):
        truth = rendering.sensor.rgb(measured[inside])[None]
        spectra = delta_e_rgb(rendering.sensor, truth, rendering.colours["atlas"])
        products = delta_e_rgb(rendering.sensor, truth, rendering.colours[RGB_PRODUCT])
        assert spectra.max() < bounds[0]
        assert products.mean() > bounds[1]


def test_the_white_of_a_light_is_white_or_has_its_tint(relit):
    for rendering in relit.renderings:
        tint = colour.XYZ_to_sRGB(
            light(rendering.light).white, apply_cctf_encoding=False
        )
        codes = 255 * colour.cctf_encoding(np.clip(tint / tint.max(), 0, 1))
        for method in relit.methods:
            balanced = rendering.screen_codes(method, balanced=True)
            tinted = rendering.screen_codes(method, balanced=False)
            assert_allclose(balanced[-1, 0], 255, atol=1.5)
            assert_allclose(tinted[-1, 0], codes, atol=1.5)


def test_lamps_look_white_but_sodium_and_candles_do_not(small_cube):
    white = ("D65", "A", "FL2", "LED-B3", "LED-RGB1", "2700K")
    relit = relight(
        "grey",
        np.full((1, 1, 3), 0.5, np.float32),
        {"a": small_cube},
        (*white, "HP1", "1900K"),
    )
    looks = {
        rendering.light for rendering in relit.renderings if rendering.is_balanced(None)
    }
    assert looks == set(white)


def test_differences_of_transparent_pixels_do_not_count(picture, small_cube, tmp_path):
    alpha = np.zeros_like(picture[..., :1])
    alpha[:30] = 1
    path = write_image(
        tmp_path / "a.exr", np.concatenate([picture * alpha, alpha], axis=-1)
    )
    read = read_picture(path, sensor("sRGB"), max_side=999)
    cubes = {"atlas": small_cube}
    whole = relight("a", read.rgb, cubes, ("A",), visible=read.visible)
    part = relight("a", read.rgb[:30], cubes, ("A",))
    expected = part.renderings[0].errors((RGB_PRODUCT, "atlas"))
    found = whole.renderings[0].errors((RGB_PRODUCT, "atlas"))
    assert found == pytest.approx(expected, rel=1e-5)


def test_a_sheet_shows_lights_as_requested(picture, small_cube, tmp_path):
    relit = relight("noise", picture[-2:], {"atlas": small_cube}, ("A", "HP1"))
    for adapt in (None, True, False):
        write_relit_sheet([relit], tmp_path / f"{adapt}.png", adapt=adapt)
    assert len({path.read_bytes() for path in tmp_path.iterdir()}) == 3


def test_cubes_of_other_spaces_are_refused(picture, small_cube, plain_cube):
    import dataclasses

    data = dataclasses.replace(plain_cube.data, sensor=sensor("Display P3"))
    other = dataclasses.replace(plain_cube, data=data)
    with raises(OptionError, "cubes-of-different-spaces"):
        relight("x", picture, {"a": small_cube, "b": other}, ("A",))
