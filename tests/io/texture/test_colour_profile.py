"""Colour spaces that image files state or the caller names, and the conversion of colours to the cube's."""

from __future__ import annotations

import struct
import zlib

import colour
import numpy as np
import pytest
from PIL import Image, ImageCms

from tests.helpers import raises
from tests.io.texture.conftest import WAVELENGTHS, planes, read_channels, write_exr
from uplift.colorimetry import delta_e_2000, lab, observer
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.common.errors import OptionError
from uplift.io import texture
from uplift.io.texture import colour_profile
from uplift.pipeline.build import build

GAMMA = struct.pack(">4sIIHxx", b"curv", 0, 1, round(2.2 * 256))
LINEAR = struct.pack(">4sII", b"curv", 0, 0)
SRGB_PARA = struct.pack(
    ">4sIHH5i", b"para", 0, 3, 0, *(round(65536 * n) for n in (2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045))
)
SRGB_1024 = (65535 * colour.models.eotf_sRGB(np.linspace(0, 1, 1024))).round().astype(int)
SRGB_TABLE = struct.pack(">4sII1024H", b"curv", 0, 1024, *SRGB_1024)


def d50(space):
    """Return the matrix from linear RGB of a colour-science space to XYZ, adapted to D50."""
    found = colour.RGB_COLOURSPACES[space]
    white = colour.xy_to_XYZ(found.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(white, [0.9642, 1, 0.8249], transform="Bradford")
    return adapt @ colour.normalised_primary_matrix(found.primaries, found.whitepoint)


def by_matrix(space, curve):
    """Build a display profile of three colorants and a tone curve."""
    tags = {
        name: struct.pack(">4sI3i", b"XYZ ", 0, *(round(65536 * value) for value in column))
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), d50(space).T, strict=True)
    }
    return icc(space, tags | dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve))


def icc(space, tags):
    text = space.encode("utf-16-be")
    tags = {b"desc": struct.pack(">4sIII4sII", b"mluc", 0, 1, 12, b"enUS", len(text), 28) + text, **tags}
    start, table, body = 132 + 12 * len(tags), b"", b""
    for name, tag in tags.items():
        table += struct.pack(">4sII", name, start + len(body), len(tag))
        body += tag + b"\0" * (-len(tag) % 4)
    size = start + len(body)
    head = struct.pack(">I4sI4s4s4s12x4s", size, b"lcms", 0x04400000, b"mntr", b"RGB ", b"XYZ ", b"acsp")
    return head.ljust(128, b"\0") + struct.pack(">I", len(tags)) + table + body


def save(path, data, codes=128):
    Image.fromarray(np.full((3, 4, 3), codes, np.uint8)).save(path, icc_profile=data)
    return path


def convert(spectral, path):
    """Convert an image; return linear RGB of its first pixel, the spaces converted from, and the codes of warnings."""
    done = texture.convert(spectral, path, path.with_name("out.exr"), force=True)
    rgb = read_channels(done.target, "RGB")[0, 0]
    return rgb, done.spaces, tuple(warning.code for warning in done.warnings)


SRGB_PROFILES = {
    "by lcms": ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    "parameters": by_matrix("sRGB", SRGB_PARA),
    "a table": by_matrix("sRGB", SRGB_TABLE),
}


@pytest.mark.parametrize("data", SRGB_PROFILES.values(), ids=SRGB_PROFILES)
@pytest.mark.parametrize("suffix", ["png", "jpg"])
def test_srgb_profiles_change_nothing(data, suffix, spectral, tmp_path):
    plain, *_ = convert(spectral, save(tmp_path / f"b.{suffix}", None))
    rgb, spaces, codes = convert(spectral, save(tmp_path / f"a.{suffix}", data))
    assert (spaces, codes) == ((), ())
    np.testing.assert_array_equal(rgb, plain)


OTHERS = [
    (by_matrix("Display P3", SRGB_PARA), "Display P3", colour.models.eotf_sRGB),
    (by_matrix("Adobe RGB (1998)", GAMMA), "Adobe RGB (1998)", lambda codes: codes ** (round(2.2 * 256) / 256)),
    (by_matrix("sRGB", LINEAR), "sRGB", lambda codes: codes),
    (by_matrix("ITU-R BT.2020", SRGB_TABLE), "ITU-R BT.2020", colour.models.eotf_sRGB),
]
CODES = np.array([120, 128, 110])


@pytest.mark.parametrize("suffix", ["png", "tif"])
@pytest.mark.parametrize(("data", "space", "curve"), OTHERS)
def test_colours_of_other_profiles_are_converted(suffix, data, space, curve, spectral, tmp_path):
    rgb, spaces, codes = convert(spectral, save(tmp_path / f"a.{suffix}", data, CODES))
    expected = conversion(observer.primaries(space), SRGB) @ curve(CODES / 255)
    assert (spaces, codes) == ((space,), ())
    np.testing.assert_allclose(rgb, expected, rtol=0, atol=2e-4)


def test_profiles_without_curves_trigger_a_warning(spectral, tmp_path):
    plain, *_ = convert(spectral, save(tmp_path / "b.png", None))
    rgb, spaces, codes = convert(spectral, save(tmp_path / "a.png", by_matrix("sRGB", b"mft2 and so on")))
    assert (spaces, codes) == ((), ("colour-space-unreadable",))
    np.testing.assert_array_equal(rgb, plain)


@pytest.mark.parametrize("suffix", ["jpg", "tif"])  # PNG files lose them when they are read
@pytest.mark.parametrize("data", [by_matrix("sRGB", GAMMA)[:300], b"no profile"], ids=["cut short", "none"])
def test_damaged_profiles_trigger_a_warning(suffix, data, spectral, tmp_path):
    assert convert(spectral, save(tmp_path / f"a.{suffix}", data))[2] == ("colour-space-unreadable",)


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


@pytest.mark.parametrize(
    ("points", "space", "curve"),
    [
        ((1, 13), None, colour.models.eotf_sRGB),
        ((12, 13), "Display P3", colour.models.eotf_sRGB),
        ((9, 8), "ITU-R BT.2020", lambda codes: codes),
        ((9, 14), "ITU-R BT.2020", colour.models.oetf_inverse_BT2020),
        ((1, 4), "sRGB", lambda codes: codes**2.2),
    ],
)
def test_code_points_of_a_png_are_used(points, space, curve, spectral, tmp_path):
    rgb, spaces, codes = convert(spectral, with_code_points(tmp_path / "a.png", points))
    expected = conversion(observer.primaries(space or "sRGB"), SRGB) @ curve(CODES / 255)
    assert (spaces, codes) == (() if space is None else (f"CICP {points[0]}, {points[1]}",), ())
    np.testing.assert_allclose(rgb, expected, rtol=0, atol=1e-3 if points[1] == 14 else 2e-4)


@pytest.mark.parametrize("points", [(9, 16), (2, 13)])
def test_unknown_code_points_trigger_a_warning(points, spectral, tmp_path):
    assert convert(spectral, with_code_points(tmp_path / "a.png", points))[2] == ("colour-space-unreadable",)


def with_code_points(path, points):
    data = save(path, None, CODES).read_bytes()
    path.write_bytes(data[:33] + chunk(b"cICP", bytes([*points, 0, 1])) + data[33:])
    return path


def exr(path, rgb, **header):
    values = np.broadcast_to(np.asarray(rgb, np.float32), (3, 4, 3))
    return write_exr(path, planes(values), **header)


ACES = colour.RGB_COLOURSPACES["ACEScg"]
AP1 = tuple(float(number) for number in (*ACES.primaries.ravel(), *ACES.whitepoint))


@pytest.mark.parametrize(
    "header",
    [
        {"colorInteropID": "lin_ap1_scene"},
        {"chromaticities": AP1},
        {"colorInteropID": "lin_ap1_scene", "chromaticities": tuple(AP1)},
        {"colorInteropID": "unknown", "chromaticities": tuple(AP1)},
    ],
)
def test_spaces_of_openexr_are_converted(header, spectral, tmp_path):
    rgb, spaces, codes = convert(spectral, exr(tmp_path / "a.exr", [0.3, 0.4, 0.2], **header))
    expected = conversion(observer.primaries("ACEScg"), SRGB) @ [0.3, 0.4, 0.2]
    assert (len(spaces), codes) == (1, ())
    np.testing.assert_allclose(rgb, expected, rtol=0, atol=2e-5)


@pytest.mark.parametrize("name", ["AP1", "ACEScg", "lin_ap1_scene", ",".join(map(str, AP1))])
def test_the_caller_overrides_the_file(name, small_cube, tmp_path):
    named = texture.prepare(small_cube, depth="float", space=name, threads=1)
    path = exr(tmp_path / "a.exr", [0.3, 0.4, 0.2], colorInteropID="lin_rec2020_scene")
    rgb, spaces, codes = convert(named, path)
    expected = conversion(observer.primaries("ACEScg"), SRGB) @ [0.3, 0.4, 0.2]
    assert (len(spaces), codes) == (1, ())
    np.testing.assert_allclose(rgb, expected, rtol=0, atol=2e-5)


def test_encoded_spaces_of_opencolorio_decode_floats(small_cube, tmp_path):
    named = texture.prepare(small_cube, depth="float", space="sRGB - Texture", threads=1)
    rgb, spaces, _ = convert(named, exr(tmp_path / "a.exr", [0.5, 0.6, 0.4]))
    assert spaces == ("sRGB Encoded Rec.709 (sRGB)",)
    np.testing.assert_allclose(rgb, colour.models.eotf_sRGB(np.array([0.5, 0.6, 0.4])), rtol=0, atol=2e-5)
    codes, *_ = convert(named, save(tmp_path / "b.png", None, CODES))
    np.testing.assert_allclose(codes, colour.models.eotf_sRGB(CODES / 255), rtol=0, atol=2e-5)
    linear = texture.prepare(small_cube, encoding="linear", space="sRGB - Texture", threads=1)
    with raises(OptionError):
        convert(linear, tmp_path / "a.exr")


def test_images_without_a_statement_are_srgb_codes_or_floats_of_the_cube(wide, tmp_path):
    rgb, spaces, codes = convert(wide, save(tmp_path / "a.png", None, CODES))
    expected = conversion(SRGB, observer.primaries("ACEScg")) @ colour.models.eotf_sRGB(CODES / 255)
    assert (spaces, codes) == (("sRGB",), ("colour-space-assumed",))
    np.testing.assert_allclose(rgb, expected, rtol=0, atol=2e-5)
    rgb, spaces, codes = convert(wide, exr(tmp_path / "b.exr", [0.3, 0.4, 0.2]))
    assert (spaces, codes) == ((), ("colour-space-assumed",))
    np.testing.assert_allclose(rgb, [0.3, 0.4, 0.2], rtol=0, atol=1e-7)


@pytest.fixture(scope="module")
def wide():
    """Uplifter of an ACEScg cube."""
    return texture.prepare(build(dim=5, space="AP1"), texture.Spectrum(WAVELENGTHS), depth="float", threads=1)


def test_an_acescg_image_and_its_srgb_twin_give_the_same_spectra(wide, spectral, tmp_path):
    codes = np.random.default_rng(0).integers(5, 251, (12, 10, 3), dtype=np.uint8)
    linear = colour.models.eotf_sRGB(codes / 255)
    Image.fromarray(codes).save(tmp_path / "srgb.png", icc_profile=SRGB_PROFILES["by lcms"])
    to_ap1 = conversion(SRGB, observer.primaries("ACEScg"))
    write_exr(tmp_path / "ap1.exr", planes((linear @ to_ap1.T).astype(np.float32)), chromaticities=AP1)
    places = np.searchsorted(observer.grid(), WAVELENGTHS)
    lights = [observer.light(name).xyz[:, places] for name in ("D65", "A", "FL11")]
    for uplifter in (spectral, wide):
        found = []
        for name in ("srgb.png", "ap1.exr"):
            done = texture.convert(uplifter, tmp_path / name, tmp_path / "out.exr", force=True)
            assert {warning.code for warning in done.warnings} <= {"pixels-unrealisable"}
            found.append(read_channels(done.target, uplifter.channels))
        for light in lights:
            white = light.sum(axis=1)
            labs = (lab(each @ light.T, white) for each in found)
            assert delta_e_2000(*labs).max() <= 0.05


def test_corrupt_profiles_do_not_raise():
    intact = by_matrix("Display P3", SRGB_PARA)
    rng = np.random.default_rng(0)
    read = 0
    for length in rng.integers(0, 2 * len(intact), 300):
        corrupt = bytearray(intact[:length])
        for place in rng.integers(0, max(len(corrupt), 1), 8 if corrupt else 0):
            corrupt[place] = rng.integers(256)
        found = colour_profile._icc_space("corrupt", bytes(corrupt))
        if found is not None:
            values = found.decode(np.linspace([0.0] * 3, [1.0] * 3, 9))
            assert np.isfinite(values).all()
            read += 1
    assert 0 < read < 300
