"""Textures and lights of passes, and pictures that are decoded."""

import json
from shutil import copyfile

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.extras.scene.passes.conftest import SIX
from tests.extras.texture.conftest import (
    channels,
    planes,
    read_channels,
    write_exr,
    write_image,
)
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OptionError, PassesError, UpliftError
from uplift.extras import texture
from uplift.extras.scene import passes as library
from uplift.extras.scene.passes.textures import ATTRIBUTE, pass_mark

NUMBERS = np.random.default_rng(3).random((30, 40, 6)).astype(np.float32)
"""Numbers of a picture in all passes."""


def write_pictures(folder, numbers, others=None, **header):
    """Write the pictures of two passes; the first one has other channels too."""
    first = planes(numbers[..., :3]) | (others or {})
    return [
        write_exr(folder / "a.1.exr", first, **header),
        write_exr(folder / "a.2.exr", planes(numbers[..., 3:]), **header),
    ]


def tiled(size):
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = size
    return {"type": OpenEXR.tiledimage, "tiles": tiles}


@pytest.mark.parametrize("layout", [{}, tiled(16), tiled(64)])
def test_decoding_is_a_matrix(two_passes, tmp_path, layout):
    depth = np.arange(1200, dtype=np.float32).reshape(30, 40)
    others = {"A": np.full((30, 40), np.inf, np.half), "Z": depth}
    decoder = library.decoder(two_passes, space="XYZ")
    sources = write_pictures(tmp_path, NUMBERS, others, **layout)
    decoded = library.decode_pictures(decoder, sources, tmp_path / "xyz.exr")
    found = channels(tmp_path / "xyz.exr")
    xyz = np.stack([found[name] for name in "XYZ"], axis=-1)
    assert_allclose(xyz, NUMBERS @ two_passes.to_xyz.T, rtol=1e-5, atol=1e-6)
    assert np.isinf(found["A"]).all()
    assert_allclose(found["first.Z"], depth)
    assert decoded.counts.pixels == 1200
    assert not decoded.warnings


def test_headers_state_the_space(two_passes):
    header = library.decoder(two_passes, space="ACEScg").header
    assert_allclose(header["chromaticities"][:2], (0.713, 0.293), atol=1e-3)
    assert json.loads(header["uplift.texture"])["space"] == "ACEScg"


def test_white_of_each_space(two_passes):
    for space in ("sRGB", "ACEScg", "ITU-R BT.2020"):
        for light in two_passes.lights:
            decoder = library.decoder(
                two_passes, space=space, light=light.name, white=light.name
            )
            assert_allclose(decoder.matrix @ light.numbers, 1, atol=0.02)
    plain = library.decoder(two_passes).matrix
    assert_allclose(plain @ two_passes.light("D65").numbers, 1, atol=0.02)
    red, _, blue = plain @ two_passes.light("A").numbers
    assert red > 1.5
    assert blue < 0.4


@pytest.mark.parametrize(
    ("number", "code"),
    [
        (-1e-6, "pixels-negative"),
        (np.nan, "pixels-not-finite"),
        (3e5, "pixels-too-bright"),
    ],
)
def test_numbers_that_cannot_be_kept_are_counted(two_passes, tmp_path, number, code):
    numbers = NUMBERS.copy()
    numbers[0, 0] = number
    sources = write_pictures(tmp_path, numbers)
    decoder = library.decoder(two_passes, space="XYZ")
    target = tmp_path / "a.exr"
    decoded = library.decode_pictures(decoder, sources, target, depth="half")
    assert decoded.counts[code] == 1
    assert [warning.code for warning in decoded.warnings] == [code]
    assert (channels(target)["Y"] <= np.half(65504)).all()


def grey(path, names="RGB", width=40, value=0.5, **header):
    plane = np.full((30, width), value, np.float32)
    return write_exr(path, dict.fromkeys(names, plane), **header)


@pytest.mark.parametrize(
    ("second", "code"),
    [
        ({"value": 0}, "passes-black"),
        ({"colorInteropID": "srgb_rec709_scene"}, "passes-not-linear"),
        ({ATTRIBUTE: "0 1 of 2"}, "passes-differ"),
        ({"width": 39}, "passes-sizes-differ"),
        ({"names": "XYZ"}, "passes-not-linear"),
        ({"names": "Z"}, "texture"),
    ],
)
def test_pictures_that_do_not_fit_are_refused(two_passes, tmp_path, second, code):
    first = grey(tmp_path / "a.exr", colorInteropID="lin_ap1_scene")
    path = grey(tmp_path / "b.exr", **second)
    decoder = library.decoder(two_passes)
    with raises(UpliftError, code) as caught:
        library.decode_pictures(decoder, [first, path], tmp_path / "c.exr")
    assert caught.value.path == path
    assert not (tmp_path / "c.exr").exists()


def test_pictures_are_those_of_the_passes_in_their_order(two_passes, tmp_path):
    first, second = write_pictures(tmp_path, NUMBERS)
    link = tmp_path / "link.exr"
    link.symlink_to(first)
    copy = copyfile(first, tmp_path / "copy.exr")
    marked = grey(tmp_path / "mark.exr", **{ATTRIBUTE: pass_mark(two_passes, 1)})
    codes = np.zeros((30, 40, 3), np.uint8)
    rows = (
        ([first], "passes-missing"),
        ([first, second, first], "passes-missing"),
        ([first, first], "passes-repeated"),
        ([first, link], "passes-repeated"),
        ([first, copy], "passes-repeated"),
        ([second, first], "passes-out-of-order"),
        ([first, marked], "passes-out-of-order"),
        ([first, write_image(tmp_path / "b.png", codes)], "passes-not-linear"),
    )
    decoder = library.decoder(two_passes)
    for sources, code in rows:
        with raises(PassesError, code):
            library.decode_pictures(decoder, sources, tmp_path / "a.exr")


def test_invalid_options_are_refused(two_passes, cube):
    with raises(OptionError):
        library.decoder(two_passes, space="ARRI LogC4")
    for number in (0, 3):
        with raises(OptionError):
            library.prepare_pass(cube, two_passes, number)


@pytest.fixture(scope="module")
def cube():
    """The packaged cube."""
    return uplift.load()


def numbers_of(source, prepare, table, passes):
    """Convert an image by both passes, and return the numbers (h, w, 6)."""
    found = []
    for number in (1, 2):
        target = source.with_name(f"out.{number}.exr")
        texture.convert(prepare(table, passes, number), source, target)
        header = OpenEXR.File(str(target)).header()
        assert "chromaticities" not in header
        assert header[ATTRIBUTE] == pass_mark(passes, number)
        found.append(read_channels(target, "RGB"))
    return np.concatenate(found, axis=-1)


def test_textures_are_band_averages(two_passes, cube, tmp_path):
    rgb = NUMBERS[:6, :7, :3]
    source = write_exr(tmp_path / "in.exr", planes(rgb))
    found = numbers_of(source, library.prepare_pass, cube, two_passes)
    spectra = cube.reflectance(rgb.astype(float), observer.grid())
    assert found.dtype == np.float16
    assert_allclose(found, spectra @ SIX.weights.T, atol=1e-3)


def test_environment_maps_are_numbers_of_lights(two_passes, tmp_path):
    rgb = np.array([[[3.0, 3, 3], [30, 22, 9], [0.2, 0.5, 2]]], np.float32)
    source = write_exr(tmp_path / "sky.exr", planes(rgb))
    table = uplift.load_emission()
    found = numbers_of(source, library.prepare_light_pass, table, two_passes)
    decoded = found[0] @ two_passes.to_xyz.T
    expected = rgb[0] @ observer.sensor().rgb_to_xyz.T
    white = expected[:, 1:2] * observer.light("D65").white
    assert delta_e_2000(lab(decoded, white), lab(expected, white)).max() < 1
