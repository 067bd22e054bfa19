"""What files say their colours are of, and that it is said when they are of another space."""

from __future__ import annotations

import struct
import zlib

import colour
import numpy as np
import OpenImageIO
import pytest
from PIL import Image, ImageCms

from uplift import observer, texture
from uplift.texture import profile

GAMMA = struct.pack(">4sIIHxx", b"curv", 0, 1, round(2.2 * 256))
LINEAR = struct.pack(">4sII", b"curv", 0, 0)
SRGB_PARA = struct.pack(">4sIHH5i", b"para", 0, 3, 0, *(round(65536 * value) for value in profile.SRGB_CURVE))


def icc(space, curve):
    """A display profile with the primaries of a space of colour-science, adapted to D50."""
    found = colour.RGB_COLOURSPACES[space]
    d50 = np.array([0.9642, 1, 0.8249])
    white = colour.xy_to_XYZ(found.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(white, d50, transform="Bradford")
    columns = adapt @ colour.normalised_primary_matrix(found.primaries, found.whitepoint)
    tags = {
        name: struct.pack(">4sI3i", b"XYZ ", 0, *(round(65536 * value) for value in column))
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), columns.T, strict=True)
    }
    tags |= dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve)
    text = space.encode("utf-16-be")
    tags[b"desc"] = struct.pack(">4sIII4sII", b"mluc", 0, 1, 12, b"enUS", len(text), 28) + text
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


def remarks(spectral, path):
    return texture.convert(spectral, path, path.with_suffix(".exr"), force=True).remarks


SRGB_TOO = [
    ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    icc("sRGB", SRGB_PARA),
    icc(
        "sRGB",
        struct.pack(
            ">4sII1024H",
            b"curv",
            0,
            1024,
            *(65535 * colour.models.eotf_sRGB(np.linspace(0, 1, 1024))).round().astype(int),
        ),
    ),
]


@pytest.mark.parametrize("data", SRGB_TOO, ids=["by lcms", "parameters", "a table"])
@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_profiles_of_srgb_need_no_remark(data, suffix, spectral, tmp_path):
    assert remarks(spectral, save(tmp_path / f"a.{suffix}", data)) == ()


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
@pytest.mark.parametrize(
    ("space", "curve", "told"),
    [
        ("Display P3", SRGB_PARA, "other primaries (Display P3)"),
        ("Adobe RGB (1998)", GAMMA, "other primaries and another curve (Adobe RGB (1998))"),
        ("sRGB", GAMMA, "another curve (sRGB)"),
        ("sRGB", LINEAR, "another curve (sRGB)"),
        ("sRGB", b"mft2 and so on", "a curve that cannot be read (sRGB)"),
    ],
)
def test_profiles_of_other_spaces_are_told(suffix, space, curve, told, spectral, tmp_path):
    path = save(tmp_path / f"a.{suffix}", icc(space, curve))
    assert remarks(spectral, path) == (f"the image names {told}; its colours are taken for sRGB",)


def test_the_profile_of_a_wide_cube_s_own_space_needs_no_remark(tmp_path):
    """Adobe RGB's white is adapted to D50 in the profile, and the cube's to its illuminant."""
    path = save(tmp_path / "a.png", icc("Adobe RGB (1998)", GAMMA))
    handle = OpenImageIO.ImageInput.open(str(path))
    found = profile.profile_of(handle.spec())
    handle.close()
    assert found.unlike(observer.sensor("Adobe RGB (1998)"), codes=True) == ""
    assert found.unlike(observer.sensor("Adobe RGB (1998)", "A"), codes=True) == ""
    assert found.unlike(observer.sensor("Display P3"), codes=True) == "other primaries and another curve"


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


@pytest.mark.parametrize(
    ("points", "told"),
    [
        ((1, 13), None),
        ((12, 13), "other primaries (CICP 12, 13)"),
        ((9, 16), "other primaries and a curve that cannot be read (CICP 9, 16)"),
        ((2, 13), "primaries that cannot be read (CICP 2, 13)"),
    ],
)
def test_code_points_of_a_png_are_told(points, told, spectral, tmp_path):
    path = save(tmp_path / "a.png", None)
    data = path.read_bytes()
    path.write_bytes(data[:33] + chunk(b"cICP", bytes([*points, 0, 1])) + data[33:])
    expected = () if told is None else (f"the image names {told}; its colours are taken for sRGB",)
    assert remarks(spectral, path) == expected


@pytest.mark.parametrize(
    ("kind", "numbers", "expected"),
    [
        (0, (2.0,), lambda x: x**2),
        (1, (2.0, 2.0, -1.0), lambda x: np.where(x >= 0.5, (2 * x - 1) ** 2, 0)),
        (2, (2.0, 1.6, -0.8, 0.25), lambda x: np.where(x >= 0.5, (1.6 * x - 0.8) ** 2 + 0.25, 0.25)),
        (3, profile.SRGB_CURVE, colour.models.eotf_sRGB),
        (
            4,
            (2.0, 0.5, 0.0, 0.5, 0.25, 0.5, 0.125),
            lambda x: np.where(x >= 0.25, x**2 / 4 + 0.5, x / 2 + 0.125),
        ),
    ],
)
def test_parametric_curves(kind, numbers, expected):
    tag = struct.pack(f">4sIHH{len(numbers)}i", b"para", 0, kind, 0, *(round(65536 * n) for n in numbers))
    np.testing.assert_allclose(profile._curve(tag), expected(profile.CODES), rtol=0, atol=1e-4)


def test_spoilt_profiles_are_read_as_far_as_they_go():
    whole = icc("Display P3", SRGB_PARA)
    rng = np.random.default_rng(0)
    for length in rng.integers(0, len(whole), 200):
        spoilt = bytearray(whole[:length])
        for place in rng.integers(0, max(length, 1), 8 if length else 0):
            spoilt[place] = rng.integers(256)
        tags = profile._tags(bytes(spoilt))
        curve = profile._curve(tags.get(b"gTRC", b""))
        assert curve is None or (np.isfinite(curve).all() and curve.shape == (256,))
        profile._colorants(tags)
