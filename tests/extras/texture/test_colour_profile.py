"""Colour spaces that image files state or the caller names, and the conversion of
colours to the cube's.
"""

import struct

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image, ImageCms

import uplift
from tests.extras.texture.conftest import planes, read_channels, write_exr
from tests.helpers import raises
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.common.errors import OptionError
from uplift.extras import texture
from uplift.extras.colour.spaces import look_up_space, primaries_of

GAMMA = struct.pack(">4sIIHxx", b"curv", 0, 1, round(2.2 * 256))
LINEAR = struct.pack(">4sIIHxx", b"curv", 0, 1, 256)
SRGB_1024 = (
    (65535 * colour.models.eotf_sRGB(np.linspace(0, 1, 1024))).round().astype(int)
)
SRGB_TABLE = struct.pack(">4sII1024H", b"curv", 0, 1024, *SRGB_1024)


def d50(space):
    """Return the matrix from linear RGB of a colour-science space to XYZ, adapted to
    D50.
    """
    found = colour.RGB_COLOURSPACES[space]
    white = colour.xy_to_XYZ(found.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        white, [0.9642, 1, 0.8249], transform="Bradford"
    )
    return adapt @ colour.normalised_primary_matrix(found.primaries, found.whitepoint)


def by_matrix(space, curve):
    """Build a display profile of three colorants and a tone curve."""
    columns = np.rint(65536 * d50(space).T).astype(int)
    tags = {
        name: struct.pack(">4sI3i", b"XYZ ", 0, *column)
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), columns, strict=True)
    }
    return icc(space, tags | dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve))


def icc(space, tags):
    text = space.encode("utf-16-be")
    tags = {
        b"desc": struct.pack(">4sIII4sII", b"mluc", 0, 1, 12, b"enUS", len(text), 28)
        + text,
        **tags,
    }
    start = 132 + 12 * len(tags)
    table = b""
    body = b""
    for name, tag in tags.items():
        table += struct.pack(">4sII", name, start + len(body), len(tag))
        body += tag + b"\0" * (-len(tag) % 4)
    size = start + len(body)
    head = struct.pack(
        ">I4sI4s4s4s12x4s",
        size,
        b"lcms",
        0x04400000,
        b"mntr",
        b"RGB ",
        b"XYZ ",
        b"acsp",
    )
    return head.ljust(128, b"\0") + struct.pack(">I", len(tags)) + table + body


def save(path, profile, codes=128):
    """Save an image with a profile."""
    pixels = np.full((3, 4, 3), codes, np.uint8)
    Image.fromarray(pixels).save(path, icc_profile=profile)
    return path


def convert(spectral, path):
    """Convert an image; return linear RGB of its first pixel, the spaces converted
    from, and the codes of warnings.
    """
    done = texture.convert(spectral, path, path.with_name("out.exr"), force=True)
    rgb = read_channels(done.target, "RGB")[0, 0]
    return rgb, done.spaces, tuple(warning.code for warning in done.warnings)


CODES = np.array([120, 128, 110])
FROM_SRGB = colour.models.eotf_sRGB(CODES / 255)
P3 = "Display P3"
ADOBE = "Adobe RGB (1998)"
BY_LCMS = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()


@pytest.mark.parametrize(
    ("suffix", "profile", "curve"),
    [
        ("png", BY_LCMS, colour.models.eotf_sRGB),
        ("tif", by_matrix("sRGB", SRGB_TABLE), colour.models.eotf_sRGB),
        ("jpg", by_matrix("sRGB", LINEAR), np.asarray),
    ],
)
def test_colours_of_profiles_are_converted(suffix, profile, curve, spectral, tmp_path):
    """`tests.fuzz.images` has profiles of other spaces and curves, and code points."""
    path = save(tmp_path / f"a.{suffix}", profile, CODES)
    rgb, spaces, codes = convert(spectral, path)
    given = np.asarray(Image.open(path))[0, 0] / 255
    assert (spaces, codes) == (("sRGB",), ())
    assert_allclose(rgb, curve(given), rtol=0, atol=2e-4)


def exr(path, rgb, **header):
    return write_exr(
        path, planes(np.broadcast_to(np.asarray(rgb, np.float32), (3, 4, 3))), **header
    )


ACES = colour.RGB_COLOURSPACES["ACEScg"]
AP1 = tuple(float(number) for number in (*ACES.primaries.ravel(), *ACES.whitepoint))


@pytest.mark.parametrize(
    "name", ["AP1", "ACEScg", "lin_ap1_scene", ",".join(map(str, AP1))]
)
def test_the_caller_overrides_the_space_of_the_file(name, small_cube, tmp_path):
    """`tests.fuzz.images` has statements of OpenEXR."""
    header = {"colorInteropID": "lin_rec2020_scene"}
    path = exr(tmp_path / "a.exr", [0.3, 0.4, 0.2], **header)
    named = texture.prepare(small_cube, depth="float", space=name, threads=1)
    rgb, spaces, codes = convert(named, path)
    expected = conversion(primaries_of(look_up_space("ACEScg")), SRGB) @ [0.3, 0.4, 0.2]
    assert (len(spaces), codes) == (1, ())
    assert_allclose(rgb, expected, rtol=0, atol=2e-5)


def test_encoded_spaces_of_opencolorio_decode_floats(small_cube, tmp_path):
    options = {"space": "sRGB - Texture", "depth": "float", "threads": 1}
    named = texture.prepare(small_cube, **options)
    floats = exr(tmp_path / "a.exr", CODES / 255)
    for path in (floats, save(tmp_path / "b.png", None, CODES)):
        rgb, spaces, _ = convert(named, path)
        assert spaces == ("sRGB Encoded Rec.709 (sRGB)",)
        assert_allclose(rgb, FROM_SRGB, rtol=0, atol=2e-5)
    with raises(OptionError):
        convert(texture.prepare(small_cube, encoding="linear", **options), floats)


def test_images_without_a_statement_are_srgb_codes_or_floats_of_the_cube(tmp_path):
    wide = texture.prepare(uplift.load("ACEScg"), depth="float", threads=1)
    to_wide = conversion(SRGB, primaries_of(look_up_space("ACEScg")))
    for path, space, expected in (
        (save(tmp_path / "a.png", None, CODES), "sRGB", to_wide @ FROM_SRGB),
        (exr(tmp_path / "b.exr", [0.3, 0.4, 0.2]), "linear ACEScg", [0.3, 0.4, 0.2]),
    ):
        rgb, spaces, codes = convert(wide, path)
        assert (spaces, codes) == ((space,), ("colour-space-assumed",))
        assert_allclose(rgb, expected, rtol=0, atol=2e-5)
