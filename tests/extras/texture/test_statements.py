"""Statements about colours that OpenImageIO does not apply: chunks, tags, channels of
CIE XYZ.

`tests.fuzz.images` draws images of all formats; these are the rules, one by one.
"""

from io import BytesIO
from itertools import chain

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tests.extras.texture import image_bytes as files
from tests.extras.texture.conftest import (
    channels,
    planes,
    rgb_of,
)
from tests.extras.texture.test_colour_profile import P3, SRGB_TABLE, by_matrix, convert
from tests.fuzz.images import wrong
from tests.helpers import raises
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.common.errors import OptionError, TextureError
from uplift.extras import texture
from uplift.extras.colour.spaces import look_up_space, primaries_of
from uplift.extras.relight.relighter import prepare_relighter

CODES = np.array([[[128, 120, 110], [60, 64, 70]]], np.uint8)
SHARE = CODES[0] / 255
FROM_SRGB = colour.models.eotf_sRGB(SHARE)
P3_TO_SRGB = conversion(primaries_of(look_up_space(P3)), SRGB)
PROFILE = by_matrix(P3, SRGB_TABLE)
P3_COLOURS = FROM_SRGB @ P3_TO_SRGB.T


LATER = [77, 87, 89, 91, 94, 97, 98, 107, 118, 121, 126, 134, 171, 175, 202, 209, 221]
LATER += [228, 235, 247, 275, 325, 369]
SEEDS = [*range(72), *LATER]
"""Some images, and the first ones that have each of the statements."""


def test_random_images_have_the_colours_that_they_state():
    """`make nightly` runs thousands."""
    assert list(chain(*map(wrong, SEEDS))) == []


@pytest.mark.parametrize(
    ("mode", "options"),
    [("P", {}), ("1", {}), ("L", {}), ("RGB", {"transparency": (128, 120, 110)})],
)
def test_pixels_of_png_are_linear_by_gamma(mode, options, to_texture, tmp_path):
    path = tmp_path / "a.png"
    image = Image.fromarray(np.repeat(CODES, 2, axis=0)).convert(mode)
    image.save(path, **options)
    data = path.read_bytes()
    path.write_bytes(data[:33] + files.gama(1) + data[33:])
    result = to_texture(path)
    expected = np.asarray(image.convert("RGB")) / 255
    assert_allclose(rgb_of(result), expected, rtol=0, atol=1e-6)
    if options:
        assert_array_equal(channels(result.target)["A"], [[0, 1]] * 2)


def png(*chunks):
    return files.png_bytes(CODES, *chunks)


def tiff(number, *value):
    return files.tiff_bytes(CODES, {number: value})


def by_pillow(mode, kind, profile):
    """A file of a library, whose profile cannot be used."""
    buffer = BytesIO()
    pixels = np.full((2, 3, len(mode)), 100, np.uint8)
    Image.fromarray(pixels, mode).save(buffer, kind, icc_profile=profile)
    return buffer.getvalue()


DAMAGED = files.png_chunk(b"iCCP", b"name\0\0x")
HLG = files.cicp(1, 18, 0, 1)
TABLE = np.rint(65535 * np.linspace(0, 1, 256) ** 1.8).astype(int).tolist()
UNUSABLE = {
    "gAMA 0.png": (png(files.gama(0)), FROM_SRGB),
    "cHRM without a gamut.png": (png(files.chrm([0.3] * 8)), FROM_SRGB),
    "gAMA of no size.png": (png(files.png_chunk(b"gAMA", b"")), FROM_SRGB),
    "a damaged profile.png": (png(DAMAGED, files.gama(1)), SHARE),
    "HLG of other primaries.png": (png(HLG, files.iccp(PROFILE)), P3_COLOURS),
    "a falling transfer function.tif": (tiff(301, 3, TABLE[::-1]), FROM_SRGB),
    "a transfer function of no size.tif": (tiff(301, 3, [1]), FROM_SRGB),
    "PRIMARIES of three numbers.hdr": (
        files.hdr_bytes(CODES, 128, "PRIMARIES= 1 2 3\n"),
        CODES / 256,
    ),
    "a part of a profile.jpg": (by_pillow("RGB", "jpeg", PROFILE[:300]), None),
    "no profile.tif": (by_pillow("RGB", "tiff", b"no profile.tif"), None),
    "colours of CMYK.jpg": (by_pillow("CMYK", "jpeg", PROFILE), None),
}


@pytest.mark.parametrize("name", UNUSABLE)
def test_the_next_statement_is_used_with_a_warning(name, spectral, tmp_path):
    content, expected = UNUSABLE[name]
    path = tmp_path / name
    path.write_bytes(content)
    rgb, _, codes = convert(spectral, path)
    assert codes == ("colour-space-assumed",)
    if expected is not None:
        assert_allclose(rgb, np.reshape(expected, (-1, 3))[0], rtol=0, atol=2e-4)


RGB = np.array([[[0.2, 0.5, 0.3], [0.9, 0.9, 0.9], [1, 1, 1], [0, 0, 0]]])
XYZ = (RGB @ SRGB.rgb_to_xyz.T).astype(np.float32)


def xyz_planes():
    return dict(zip("XYZ", planes(XYZ).values(), strict=True))


def test_relit_images_of_xyz_are_rgb(small_cube, to_texture):
    relighter = prepare_relighter(small_cube, ["A"], threads=1)
    expected = rgb_of(to_texture(planes(RGB.astype(np.float32)), relighter))
    result = to_texture(xyz_planes(), relighter, whiteLuminance=1.0)
    assert_allclose(rgb_of(result), expected, rtol=0, atol=2e-3)
    assert set(channels(result.target)) == set("RGB")


def test_xyz_are_neither_encoded_nor_rgb_of_a_space(small_cube, to_texture):
    for options, error in (
        ({"space": "ACEScg"}, TextureError),
        ({"encoding": "encoded"}, OptionError),
    ):
        uplifter = texture.prepare(small_cube, threads=1, **options)
        with raises(error):
            to_texture(xyz_planes(), uplifter)
    space = "CIE XYZ-D65 - Scene-referred"
    named = texture.prepare(small_cube, depth="float", space=space, threads=1)
    result = to_texture(xyz_planes(), named)
    assert_allclose(rgb_of(result), RGB, rtol=0, atol=1e-3)


def test_rgb_channels_of_a_space_of_xyz_keep_its_white(to_texture):
    result = to_texture(planes(XYZ), colorInteropID="lin_ciexyzd65_scene")
    assert_allclose(rgb_of(result), RGB, rtol=0, atol=1e-3)
