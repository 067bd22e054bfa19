"""What files say their colours are of, and that it is said when they are of another space."""

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
    """Linear RGB of a space of colour-science to XYZ, adapted to D50."""
    found = colour.RGB_COLOURSPACES[space]
    white = colour.xy_to_XYZ(found.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        white, [0.9642, 1, 0.8249], transform="Bradford"
    )
    return adapt @ colour.normalised_primary_matrix(found.primaries, found.whitepoint)


def by_matrix(space, curve):
    """A display profile of three colorants and a curve."""
    tags = {
        name: struct.pack(">4sI3i", b"XYZ ", 0, *(round(65536 * value) for value in column))
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), d50(space).T, strict=True)
    }
    return icc(space, tags | dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve))


def by_table(space):
    """The same with the curve of sRGB, and a table of what each corner of RGB has for a matrix."""
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


def remarks(spectral, path):
    return texture.convert(spectral, path, path.with_suffix(".exr"), force=True).remarks


SRGB_TOO = {
    "by lcms": ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    "parameters": by_matrix("sRGB", SRGB_PARA),
    "a table": by_matrix("sRGB", SRGB_TABLE),
}


@pytest.mark.parametrize("data", SRGB_TOO.values(), ids=SRGB_TOO)
@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_profiles_of_srgb_need_no_remark(data, suffix, spectral, tmp_path):
    assert remarks(spectral, save(tmp_path / f"a.{suffix}", data)) == ()


CANNOT = "primaries that cannot be read and a curve that cannot be read"
OTHERS = [
    (by_matrix("Display P3", SRGB_PARA), "other primaries (Display P3)"),
    (by_table("sRGB"), "primaries that cannot be read (sRGB)"),
    (by_matrix("Adobe RGB (1998)", GAMMA), "other primaries and another curve (Adobe RGB (1998))"),
    (by_matrix("sRGB", GAMMA), "another curve (sRGB)"),
    (by_matrix("sRGB", LINEAR), "another curve (sRGB)"),
    (by_matrix("sRGB", b"mft2 and so on"), f"{CANNOT} (sRGB)"),
]


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
@pytest.mark.parametrize(("data", "told"), OTHERS)
def test_profiles_of_other_spaces_are_told(suffix, data, told, spectral, tmp_path):
    path = save(tmp_path / f"a.{suffix}", data)
    assert remarks(spectral, path) == (f"the image names {told}; its colours are taken for sRGB",)


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
def test_profiles_that_cannot_be_read_are_told(suffix, data, name, spectral, tmp_path):
    (told,) = remarks(spectral, save(tmp_path / f"a.{suffix}", data))
    assert told == f"the image names {CANNOT} ({name}); its colours are taken for sRGB"


def test_the_profile_of_a_wide_cube_s_own_space_needs_no_remark(tmp_path):
    """Adobe RGB's white is adapted to D50 in the profile, and the cube's to its illuminant."""
    path = save(tmp_path / "a.png", by_matrix("Adobe RGB (1998)", GAMMA))
    handle = OpenImageIO.ImageInput.open(str(path))
    found = colour_profile.profile_of(handle.spec())
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


def test_spoilt_profiles_are_read_as_far_as_they_go():
    whole = by_matrix("Display P3", SRGB_PARA)
    rng = np.random.default_rng(0)
    read = 0
    for length in rng.integers(0, 2 * len(whole), 300):
        spoilt = bytearray(whole[:length])
        for place in rng.integers(0, max(len(spoilt), 1), 8 if spoilt else 0):
            spoilt[place] = rng.integers(256)
        found = colour_profile._icc("spoilt", bytes(spoilt))
        assert found.greys is None or found.greys.shape == (256, 3)
        read += found.greys is not None
    assert 0 < read < 300
