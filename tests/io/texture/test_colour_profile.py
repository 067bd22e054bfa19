"""Colour spaces that image files state, and warnings about spaces that differ from the cube's."""

from __future__ import annotations

import itertools
import struct
import zlib

import colour
import numpy as np
import OpenImageIO
import pytest
from PIL import Image, ImageCms

from uplift.colorimetry import observer
from uplift.io import texture
from uplift.io.texture import colour_profile

GAMMA = struct.pack(">4sIIHxx", b"curv", 0, 1, round(2.2 * 256))
LINEAR = struct.pack(">4sII", b"curv", 0, 0)
SRGB_PARA = struct.pack(
    ">4sIHH5i",
    b"para",
    0,
    3,
    0,
    *(round(65536 * n) for n in (2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)),
)
SRGB_1024 = (65535 * colour.models.eotf_sRGB(np.linspace(0, 1, 1024))).round().astype(int)
SRGB_TABLE = struct.pack(">4sII1024H", b"curv", 0, 1024, *SRGB_1024)


def d50(space):
    """Return the matrix from linear RGB of a colour-science space to XYZ, adapted to D50."""
    found = colour.RGB_COLOURSPACES[space]
    white = colour.xy_to_XYZ(found.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        white, [0.9642, 1, 0.8249], transform="Bradford"
    )
    return adapt @ colour.normalised_primary_matrix(found.primaries, found.whitepoint)


def by_matrix(space, curve):
    """Build a display profile of three colorants and a tone curve."""
    tags = {
        name: struct.pack(">4sI3i", b"XYZ ", 0, *(round(65536 * value) for value in column))
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), d50(space).T, strict=True)
    }
    return icc(space, tags | dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve))


def by_table(space):
    """Build a profile with the sRGB curve, and a lookup table of the corners of RGB for a matrix."""
    corners = np.maximum(np.array(list(itertools.product((0, 1), repeat=3))) @ d50(space).T, 0)
    head = struct.pack(">4sI4B9i2H", b"mft2", 0, 3, 3, 2, 0, *(65536 * np.eye(3, dtype=int)).ravel(), 1024, 2)
    numbers = [*np.tile(SRGB_1024, 3), *(32768 * corners).round().astype(int).ravel(), *(0, 65535) * 3]
    return icc(space, {b"A2B0": head + struct.pack(f">{len(numbers)}H", *numbers)})


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


def problems(spectral, path):
    """Convert an image and return the text of its colour-space warnings."""
    warnings = texture.convert(spectral, path, path.with_suffix(".exr"), force=True).warnings
    assert {warning.code for warning in warnings} <= {"colour-space-mismatch"}
    return tuple(warning.problem for warning in warnings)


SRGB_PROFILES = {
    "by lcms": ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    "parameters": by_matrix("sRGB", SRGB_PARA),
    "a table": by_matrix("sRGB", SRGB_TABLE),
}


@pytest.mark.parametrize("data", SRGB_PROFILES.values(), ids=SRGB_PROFILES)
@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_srgb_profiles_trigger_no_warning(data, suffix, spectral, tmp_path):
    assert problems(spectral, save(tmp_path / f"a.{suffix}", data)) == ()


UNREADABLE = "unreadable primaries and an unreadable tone curve"
OTHERS = [
    (by_matrix("Display P3", SRGB_PARA), "other primaries (Display P3)"),
    (by_table("sRGB"), "unreadable primaries (sRGB)"),
    (by_matrix("Adobe RGB (1998)", GAMMA), "other primaries and another tone curve (Adobe RGB (1998))"),
    (by_matrix("sRGB", GAMMA), "another tone curve (sRGB)"),
    (by_matrix("sRGB", LINEAR), "another tone curve (sRGB)"),
    (by_matrix("sRGB", b"mft2 and so on"), f"{UNREADABLE} (sRGB)"),
]


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
@pytest.mark.parametrize(("data", "mismatch"), OTHERS)
def test_profiles_of_other_spaces_trigger_a_warning(suffix, data, mismatch, spectral, tmp_path):
    path = save(tmp_path / f"a.{suffix}", data)
    assert problems(spectral, path) == (f"the image states {mismatch}; its colours are read as sRGB",)


@pytest.mark.parametrize("suffix", ["jpg", "tif"])  # PNG files lose them when they are read
@pytest.mark.parametrize(
    ("data", "name"),
    [
        (by_matrix("sRGB", GAMMA)[:300], "an ICC profile without a name"),
        (by_matrix("sRGB", GAMMA).replace(b"RGB ", b"GRAY"), "sRGB"),
        (b"no profile", "an ICC profile without a name"),
    ],
    ids=["cut short", "of greys", "none"],
)
def test_unreadable_profiles_trigger_a_warning(suffix, data, name, spectral, tmp_path):
    (problem,) = problems(spectral, save(tmp_path / f"a.{suffix}", data))
    assert problem == f"the image states {UNREADABLE} ({name}); its colours are read as sRGB"


def test_the_profile_of_a_wide_gamut_cube_matches_its_space(tmp_path):
    """The profile adapts white to D50, the cube adapts it to its illuminant."""
    path = save(tmp_path / "a.png", by_matrix("Adobe RGB (1998)", GAMMA))
    handle = OpenImageIO.ImageInput.open(str(path))
    found = colour_profile.read_profile(handle.spec())
    handle.close()
    assert found.mismatch(observer.sensor("Adobe RGB (1998)"), encoded=True) == ""
    assert found.mismatch(observer.sensor("Adobe RGB (1998)", "A"), encoded=True) == ""
    assert (
        found.mismatch(observer.sensor("Display P3"), encoded=True)
        == "other primaries and another tone curve"
    )


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


@pytest.mark.parametrize(
    ("points", "mismatch"),
    [
        ((1, 13), None),
        ((12, 13), "other primaries (CICP 12, 13)"),
        ((9, 16), "other primaries and an unreadable tone curve (CICP 9, 16)"),
        ((2, 13), "unreadable primaries (CICP 2, 13)"),
    ],
)
def test_code_points_of_a_png_are_compared(points, mismatch, spectral, tmp_path):
    path = save(tmp_path / "a.png", None)
    data = path.read_bytes()
    path.write_bytes(data[:33] + chunk(b"cICP", bytes([*points, 0, 1])) + data[33:])
    expected = () if mismatch is None else (f"the image states {mismatch}; its colours are read as sRGB",)
    assert problems(spectral, path) == expected


def test_corrupt_profiles_do_not_raise():
    intact = by_matrix("Display P3", SRGB_PARA)
    rng = np.random.default_rng(0)
    read = 0
    for length in rng.integers(0, 2 * len(intact), 300):
        corrupt = bytearray(intact[:length])
        for place in rng.integers(0, max(len(corrupt), 1), 8 if corrupt else 0):
            corrupt[place] = rng.integers(256)
        found = colour_profile._read_icc("corrupt", bytes(corrupt))
        assert found.greys is None or found.greys.shape == (256, 3)
        read += found.greys is not None
    assert 0 < read < 300
