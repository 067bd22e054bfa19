"""Statements about colours that OpenImageIO does not apply: chunks, tags, channels of
CIE XYZ, light without alpha.

`tests.fuzz.images` draws images of all formats; these are the rules, one by one.
"""

from itertools import chain

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tests.extras.texture import image_bytes as files
from tests.extras.texture.conftest import (
    WAVELENGTHS,
    channels,
    planes,
    read_channels,
    rgb_of,
    write_exr,
    write_image,
)
from tests.extras.texture.test_colour_profile import P3, SRGB_TABLE, by_matrix, convert
from tests.fuzz.images import wrong
from tests.helpers import raises
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.common.errors import OptionError, TextureError
from uplift.extras import texture
from uplift.extras.colour.spaces import look_up_space, primaries_of
from uplift.extras.images.picture import read_picture
from uplift.extras.relight.relighter import prepare_relighter

CODES = np.array([[[128, 120, 110], [60, 64, 70]]], np.uint8)
SHARE = CODES[0] / 255
FROM_SRGB = colour.models.eotf_sRGB(SHARE)
P3_TO_SRGB = conversion(primaries_of(look_up_space(P3)), SRGB)
PROFILE = by_matrix(P3, SRGB_TABLE)
P3_COLOURS = FROM_SRGB @ P3_TO_SRGB.T


@pytest.fixture
def png(tmp_path):
    """Function that writes a PNG file of codes and chunks."""

    def png(*args, **options):
        path = tmp_path / "a.png"
        path.write_bytes(files.png_bytes(*args, **options))
        return path

    return png


SEEDS = [*range(60), 77, 94, 97, 98, 101, 118, 119, 147, 160, 196, 202, 275]
"""Some images, and the first ones that have each of the statements."""


def test_random_images_have_the_colours_that_they_state():
    """`make nightly` runs thousands."""
    assert list(chain(*map(wrong, SEEDS))) == []


def test_the_statements_that_were_used_are_named(spectral, png):
    path = png(CODES, files.gama(1), files.chrm(files.BT2020))
    assert convert(spectral, path)[1] == ("gAMA 1 and cHRM",)
    path = path.with_name("a.hdr")
    path.write_bytes(files.hdr_bytes(CODES, 128, "PRIMARIES= 1 2 3\n"))
    assert convert(spectral, path)[2] == ("colour-space-assumed",)


def test_chunks_after_the_pixels_are_ignored(spectral, png):
    rgb, _, codes = convert(spectral, png(CODES, after=files.gama(1)))
    assert_allclose(rgb, FROM_SRGB[0], rtol=0, atol=1e-5)
    assert codes == ()


@pytest.mark.parametrize("mode", ["P", "1", "L"])
def test_palettes_and_bits_of_png_are_linear_by_gamma(mode, to_texture, tmp_path):
    path = tmp_path / "a.png"
    image = Image.fromarray(np.repeat(CODES, 2, axis=0)).convert(mode)
    image.save(path)
    data = path.read_bytes()
    path.write_bytes(data[:33] + files.gama(1) + data[33:])
    result = to_texture(path)
    expected = np.asarray(image.convert("RGB")) / 255
    assert_allclose(rgb_of(result), expected, rtol=0, atol=1e-6)


def test_a_transparent_colour_of_png_does_not_change_the_gamma(to_texture, png):
    transparent = files.png_chunk(b"tRNS", CODES[0, 0].astype(">u2").tobytes())
    result = to_texture(png(CODES, files.gama(1), transparent))
    assert_allclose(rgb_of(result)[0], SHARE, rtol=0, atol=1e-6)
    assert_array_equal(channels(result.target)["A"][0], [0, 1])


UNUSABLE = {
    "gAMA 0": ((files.gama(0),), FROM_SRGB),
    "cHRM without a gamut": ((files.chrm([0.3] * 8),), FROM_SRGB),
    "gAMA of no size": ((files.png_chunk(b"gAMA", b""),), FROM_SRGB),
    "a damaged profile": (
        (files.png_chunk(b"iCCP", b"name\0\0x"), files.gama(1)),
        SHARE,
    ),
    "HLG of other primaries": (
        (files.cicp(1, 18, 0, 1), files.iccp(PROFILE)),
        P3_COLOURS,
    ),
}


@pytest.mark.parametrize(("chunks", "expected"), UNUSABLE.values(), ids=UNUSABLE)
def test_the_next_statement_is_used_with_a_warning(chunks, expected, spectral, png):
    rgb, _, codes = convert(spectral, png(CODES, *chunks))
    assert_allclose(rgb, expected[0], rtol=0, atol=2e-4)
    assert codes == ("colour-space-assumed",)


def test_bright_colours_of_pq_are_mapped_with_a_warning(to_texture, png):
    codes = np.array([[[200, 200, 200], [100, 100, 100]]], np.uint8)
    result = to_texture(png(codes, files.cicp(9, 16, 0, 1)))
    expected = np.minimum(colour.models.eotf_ST2084(codes[0] / 255) / 100, 1)
    assert_allclose(rgb_of(result)[0], expected, rtol=0, atol=1e-3)
    assert [warning.code for warning in result.warnings] == ["pixels-out-of-gamut"]
    assert result.counts["pixels-out-of-gamut"] == 1


TABLE = np.rint(65535 * np.linspace(0, 1, 256) ** 1.8).astype(int).tolist()


@pytest.mark.parametrize(
    "tags",
    [{318: (5, [0.3457, 0.3585])}, {301: (3, TABLE[::-1])}, {301: (3, [1])}],
)
def test_tags_that_cannot_be_used_trigger_a_warning(tags, spectral, tmp_path):
    path = tmp_path / "a.tif"
    path.write_bytes(files.tiff_bytes(CODES, tags))
    rgb, _, codes = convert(spectral, path)
    assert_allclose(rgb, FROM_SRGB[0], rtol=0, atol=1e-5)
    assert codes == ("colour-space-assumed",)


def test_colours_of_other_models_are_refused_or_assumed(spectral, tmp_path):
    Image.fromarray(np.full((2, 3, 4), 100, np.uint8), "CMYK").save(
        tmp_path / "a.jpg", icc_profile=PROFILE
    )
    assert convert(spectral, tmp_path / "a.jpg")[2] == ("colour-space-assumed",)
    Image.fromarray(np.full((2, 3, 3), 100, np.uint8), "LAB").save(tmp_path / "a.tif")
    with raises(TextureError):
        convert(spectral, tmp_path / "a.tif")


RGB = np.array([[[0.2, 0.5, 0.3], [0.9, 0.9, 0.9], [1, 1, 1], [0, 0, 0]]])
XYZ = RGB @ SRGB.rgb_to_xyz.T


def xyz_planes(xyz, layer="", dtype=np.float32):
    x, y, z = planes(xyz.astype(dtype)).values()
    return {f"{layer}X": x, f"{layer}Y": y, f"{layer}Z": z}


@pytest.mark.parametrize("layer", ["", "beauty."])
@pytest.mark.parametrize("dtype", [np.float32, np.float16])
def test_channels_of_xyz_are_converted(layer, dtype, to_texture):
    alpha = np.array([[0.5, 1, 0.7, 0]])
    held = xyz_planes(XYZ * alpha[..., None], layer, dtype) | {
        f"{layer}A": alpha.astype(dtype)
    }
    result = to_texture(held)
    expected = RGB * alpha[..., None]
    tolerance = 1e-4 if dtype is np.float32 else 3e-3
    assert_allclose(rgb_of(result), expected, rtol=0, atol=tolerance)
    assert result.warnings == ()
    assert not {f"{layer}X", f"{layer}Y", f"{layer}Z"} & set(channels(result.target))


def test_xyz_are_relative_to_the_white_of_the_file(to_texture):
    aces = look_up_space("ACES2065-1")
    primaries = primaries_of(aces)
    stated = tuple(map(float, (*aces.primaries.ravel(), *aces.whitepoint)))
    result = to_texture(
        xyz_planes(100 * RGB @ primaries.rgb_to_xyz.T),
        chromaticities=stated,
        whiteLuminance=100.0,
    )
    expected = np.clip(RGB @ conversion(primaries, SRGB).T, 0, 1)
    assert_allclose(rgb_of(result), expected, rtol=0, atol=3e-4)
    assert "100" in result.spaces[0]


def test_relit_images_of_xyz_are_rgb(small_cube, to_texture):
    relighter = prepare_relighter(small_cube, ["A"], threads=1)
    expected = rgb_of(to_texture(planes(RGB.astype(np.float32)), relighter))
    relit = rgb_of(to_texture(xyz_planes(XYZ), relighter))
    assert_allclose(relit.astype(float), expected.astype(float), rtol=0, atol=2e-3)


@pytest.mark.parametrize(
    "names",
    [
        ("X", "Y"),
        ("Y", "RY", "BY"),
        ("N.X", "N.Y", "N.Z"),
        ("View.Normal.X", "View.Normal.Y", "View.Normal.Z"),
    ],
)
def test_other_channels_are_neither_grey_nor_xyz(names, to_texture):
    with raises(TextureError):
        to_texture({name: np.full((2, 2), 0.5, np.float32) for name in names})


def test_xyz_are_neither_encoded_nor_rgb_of_a_space(small_cube, to_texture, tmp_path):
    source = write_exr(tmp_path / "a.exr", xyz_planes(XYZ))
    for options, error in (
        ({"space": "ACEScg"}, TextureError),
        ({"encoding": "encoded"}, OptionError),
    ):
        with raises(error):
            to_texture(source, texture.prepare(small_cube, threads=1, **options))
    named = texture.prepare(
        small_cube, depth="float", space="CIE XYZ-D65 - Scene-referred", threads=1
    )
    result = to_texture(source, named)
    assert_allclose(rgb_of(result), RGB, rtol=0, atol=1e-3)


def test_rgb_channels_of_a_space_of_xyz_keep_its_white(to_texture):
    result = to_texture(
        planes(XYZ.astype(np.float32)), colorInteropID="lin_ciexyzd65_scene"
    )
    assert_allclose(rgb_of(result), RGB, rtol=0, atol=1e-3)


@pytest.mark.parametrize("dtype", [np.float32, np.float16])
def test_light_without_opacity_stays(dtype, spectral, to_texture):
    dark = [3e-7, 2e-7, 1e-7]
    light = np.array([[*[[0.3, 0.2, 0.1]] * 2, [0.25, 0.1, 0], [0, 0, 0], dark]])
    alpha = np.array([[0, 1e-6, 0.5, 0, 1e-6]])
    light = light.astype(dtype)
    alpha = alpha.astype(dtype)
    result = to_texture({**planes(light), "A": alpha})
    assert result.warnings == ()
    assert_array_equal(channels(result.target)["A"], alpha)
    assert_allclose(rgb_of(result), light, rtol=0, atol=1e-4)
    spectra = read_channels(result.target, spectral.channels)
    expected = spectral.cube.reflectance(light[0, :2].astype(float), WAVELENGTHS)
    assert_allclose(spectra[0, :2], expected, rtol=0, atol=1e-5)
    assert (spectra[0, 3] == 0).all()


def test_signalling_nan_are_counted_without_a_warning_of_numpy(to_texture):
    bad = np.full((1, 3), 0x7F800001, np.uint32).view(np.float32)
    result = to_texture({**dict.fromkeys("RGB", bad), "A": bad})
    assert result.counts["pixels-not-finite"] == 3


def test_pictures_show_light_without_opacity(sensor, tmp_path):
    light = np.full((1, 2, 3), 0.25, np.float32)
    alpha = np.array([[0, 0.5]], np.float32)
    source = write_exr(tmp_path / "a.exr", {**planes(light), "A": alpha})
    picture = read_picture(source, sensor, max_side=2)
    assert_allclose(picture.rgb[0], [[0.25] * 3, [0.5] * 3])


def test_floats_leave_the_unit_interval_by_rounding_only(to_texture, tmp_path):
    near = np.array([[[1 + 2.0**-23, -1e-9, 0.5], [-1e-7, 1 + 5e-7, 1]]], np.float32)
    for source in (planes(near), write_image(tmp_path / "a.tif", near)):
        assert to_texture(source).warnings == ()
    assert (
        to_texture(planes(near + np.float32(1e-4))).counts["pixels-out-of-gamut"] == 2
    )
