"""Conversion of images: decoding, gamut mapping, parts and channels that pass through;
reduced pictures.
"""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tests.extras.texture.conftest import (
    WAVELENGTHS,
    planes,
    read_channels,
    rgb_of,
    small_tiles,
    spectra_by,
    write_exr,
    write_image,
)
from tests.helpers import raises
from uplift.colorimetry.gamut import map_to_gamut
from uplift.common.errors import ColourError, TextureError
from uplift.extras import texture
from uplift.extras.colour.spaces import find_space
from uplift.extras.images.image import open_image
from uplift.extras.images.picture import read_picture


def test_floats_are_linear_unless_the_encoding_is_given(
    colours, to_texture, small_cube, tmp_path
):
    values = colours[..., 0]
    codes = np.rint(values * 255).astype(np.uint8)
    Image.fromarray(values).save(tmp_path / "float.tif")
    Image.fromarray(codes).save(tmp_path / "codes.png")
    for name, encoding, expected in (
        ("float.tif", "auto", values),
        ("float.tif", "encoded", small_cube.decode(255.0 * values)),
        ("codes.png", "linear", codes / 255),
    ):
        uplifter = texture.prepare(small_cube, encoding=encoding, depth="float")
        grey = rgb_of(to_texture(tmp_path / name, uplifter))[..., 0]
        assert_allclose(grey, expected, rtol=0, atol=1e-6, err_msg=encoding)


UPRIGHT = np.arange(24, dtype=np.uint8).reshape(4, 6) * 10
STORED = [
    *(UPRIGHT, UPRIGHT[:, ::-1], UPRIGHT[::-1, ::-1], UPRIGHT[::-1]),
    *(UPRIGHT.T, UPRIGHT.T[::-1], UPRIGHT.T[::-1, ::-1], UPRIGHT.T[:, ::-1]),
]
"""Rows of files by orientation, from 1 (EXIF 2.32, 4.6.4)."""
HDR_AXES = ("-Y +X", "-Y -X", "+Y -X", "+Y +X", "+X -Y", "-X -Y", "-X +Y", "+X +Y")


@pytest.mark.parametrize("number", range(8))
@pytest.mark.parametrize("suffix", ["jpg", "png", "tif", "hdr"])
def test_images_are_upright(suffix, number, tmp_path):
    path = tmp_path / f"photo.{suffix}"
    stored = np.repeat(STORED[number][..., None], 3, axis=2)
    write_image(path, stored, Orientation=1 + number)
    if suffix == "hdr":
        size = "{0} {2} {1} {3}".format(*HDR_AXES[number].split(), *stored.shape)
        head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n"
        pixels = np.insert(stored, 3, 136, axis=2)
        path.write_bytes(head.encode() + pixels.tobytes())
    with open_image(path) as image:
        (part,) = image.parts
        rows = np.concatenate([band for _, band in image.bands(part)])
    assert_allclose(rows[..., 0], UPRIGHT, atol=8)
    assert (part.window.height, part.window.width) == UPRIGHT.shape


@pytest.mark.parametrize("name", ["T.550,000000nm", "S0.550,5nm", "moment.03", "T.x"])
def test_spectra_that_are_not_used_are_stated(name, sensor, tmp_path):
    content = planes(np.full((2, 2, 3), 0.5, np.float32))
    path = write_exr(tmp_path / "a.exr", content | {name: content["R"]})
    notes = read_picture(path, sensor, max_side=9).warnings
    assert [note.code for note in notes] == ["spectra-not-used"] * (name != "T.x")


def mapping(uplifter, method):
    """Return the same uplifter with another gamut mapping."""
    return replace(uplifter, reader=replace(uplifter.reader, out_of_gamut=method))


@pytest.mark.parametrize("method", ["clip", "scale", "desaturate", "desaturate-oklab"])
def test_only_invalid_pixels_are_mapped_and_counted(
    method, colours, to_texture, spectral
):
    bad = colours.copy()
    bad[3, :5] = [[-0.25, 0.5, 2], [8, 4, 1], [0.2, 0.6, -0.1], [-1] * 3, [7] * 3]
    bad[4, 4] = (np.inf, 5, np.nan)
    bad[4, 5] = np.nan
    result = to_texture(planes(bad), mapping(spectral, method))
    bad[4, 4] = (1, 1, 0)
    bad[4, 5] = 0
    mapped = map_to_gamut(bad, spectral.cube.data.sensor, method)
    assert_array_equal(rgb_of(result), mapped.rgb)
    outside = result.counts.changes["pixels-out-of-gamut"]
    assert (outside.pixels, outside.largest) == (5, mapped.max_change)
    assert (result.counts.pixels, result.counts["pixels-not-finite"]) == (600, 2)
    assert [(note.code, note.path) for note in result.warnings] == [
        ("pixels-out-of-gamut", result.source),
        ("pixels-not-finite", result.source),
    ]
    spectra = read_channels(result.target, spectral.channels)
    expected = spectral.cube.reflectance(mapped.rgb, WAVELENGTHS)
    assert_allclose(spectra, expected, atol=1e-6)


@pytest.mark.parametrize("bad", [1.5, -0.5, np.nan])
def test_pixels_outside_can_be_an_error(bad, colours, spectral, to_texture, tmp_path):
    rgb = colours.copy()
    rgb[3, 3, 0] = bad
    code = "colour" if np.isnan(bad) else "rgb-out-of-gamut"
    with raises(ColourError, code) as caught:
        to_texture(planes(rgb), mapping(spectral, "error"))
    assert caught.value.path == tmp_path / "in.exr"
    assert f"({bad:g}, " in caught.value.problem
    assert not (tmp_path / "out.exr").exists()


@pytest.mark.parametrize("kind", [OpenEXR.scanlineimage, OpenEXR.tiledimage])
@pytest.mark.parametrize("band", [1, 1 << 25])
def test_parts_windows_and_other_channels_are_kept(
    kind, band, spectral, to_texture, tmp_path, monkeypatch
):
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    rng = np.random.default_rng(2)
    rgb = rng.random((20, 33, 3)).astype(np.float16)
    depth = rng.normal(0, 1e6, (20, 33)).astype(np.float32)
    depth[0, :3] = (np.nan, np.inf, -np.inf)
    others: dict[str, np.ndarray] = {
        "mask": rgb[..., 0].copy(),
        "Z": depth,
        "id": rng.integers(0, 1 << 24, (20, 33), dtype=np.uint32, endpoint=True),
    }
    header = {
        "dataWindow": ((5, -7), (37, 12)),
        "displayWindow": ((0, 0), (99, 79)),
        "pixelAspectRatio": 2.0,
    }
    tiles = {"tiles": small_tiles()} if kind == OpenEXR.tiledimage else {}
    view = {f"view.{name}": plane for name, plane in planes(rgb[::-1]).items()}
    contents = {"left": {**planes(rgb), **others}, "depth": {"Z": depth}, "right": view}
    parts = [
        OpenEXR.Part({"type": kind, **header, **tiles}, held, name)
        for name, held in contents.items()
    ]
    OpenEXR.File(parts).write(str(tmp_path / "in.exr"))
    result = to_texture(tmp_path / "in.exr")
    assert result.counts.pixels == 2 * 20 * 33
    parts = OpenEXR.File(str(result.target), separate_channels=True).parts
    for name, part in zip(contents, parts, strict=True):
        assert part.name() == name
        for attribute, value in header.items():
            assert_array_equal(part.header[attribute], value)
    for name, plane in others.items():
        found = parts[0].channels[name].pixels
        assert found.dtype == plane.dtype
        assert_array_equal(found, plane)
    assert set(parts[1].channels) == {"Z"}
    for number, shown in ((0, rgb), (2, rgb[::-1])):
        found = read_channels(result.target, spectral.channels, number)
        expected = spectral.cube.reflectance(shown, WAVELENGTHS)
        assert_allclose(found, expected, rtol=0, atol=1e-6)


ZERO = np.zeros((4, 5), np.float32)
RGB = dict.fromkeys("RGB", ZERO)
TWO_LAYERS = dict.fromkeys(("a.R", "a.G", "a.B", "b.R", "b.G", "b.B"), ZERO)
TOO_LARGE = np.full((4, 5), (1 << 24) + 1, np.uint32)


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("none.png", None, "file-not-found"),
        (".", None, "file-unreadable"),
        ("text.png", "no image", "texture"),
        ("a.bmp", Image.new("RGB", (5, 4)), "texture"),
        ("lab.tif", Image.new("LAB", (5, 4)), "texture"),
        ("depth.exr", {"Z": ZERO}, "texture"),
        ("layers.exr", TWO_LAYERS, "texture"),
        ("integers.exr", dict.fromkeys("RGB", ZERO.astype(np.uint32)), "texture"),
        ("float32-cannot-hold.exr", {**RGB, "id": TOO_LARGE}, "texture"),
        ("spectral.exr", {**RGB, "T.400,000000nm": ZERO}, "texture"),
        ("no-grey.exr", dict.fromkeys(("X", "Y"), ZERO), "texture"),
        ("chroma.exr", dict.fromkeys(("Y", "RY", "BY"), ZERO), "texture"),
        ("normals.exr", dict.fromkeys(("N.X", "N.Y", "N.Z"), ZERO), "texture"),
    ],
)
def test_unusable_images_are_refused(name, content, code, to_texture, tmp_path):
    path = tmp_path / name
    if isinstance(content, str):
        path.write_text(content)
    elif isinstance(content, dict):
        write_exr(path, content)
    elif content is not None:
        content.save(path)
    with raises(TextureError, code) as caught:
        to_texture(path)
    assert caught.value.path == path
    assert not (tmp_path / "out.exr").exists()


STATEMENTS = {
    "owner": ("string", "a studio"),
    "crew": ("string[2]", ("Ann", "Bo")),
    "framesPerSecond": ("rational", (24000, 1001)),
    "smpte:TimeCode": ("timecode", (0x01020304, 0)),
    "worldToCamera": ("matrix", tuple(range(16))),
    "screenWindowCenter": ("float[2]", (0.25, 0.5)),
    "colorInteropID": ("string", "lin_rec709_scene"),
}


def test_statements_of_the_image_are_kept(to_texture, tmp_path):
    typed = {
        name: (OpenImageIO.TypeDesc(kind), value)
        for name, (kind, value) in STATEMENTS.items()
    }
    write_image(tmp_path / "a.exr", np.zeros((3, 4, 3), np.float32), **typed)
    result = to_texture(tmp_path / "a.exr")
    before = OpenEXR.File(str(result.source)).header()
    after = OpenEXR.File(str(result.target)).header()
    assert before.keys() - after.keys() == {"colorInteropID"}
    assert before["framesPerSecond"] == Fraction(24000, 1001)
    for name in ("timeCode", *(STATEMENTS.keys() & after.keys())):
        assert_array_equal(after[name], before[name], err_msg=name)


def test_pictures_are_means_of_linear_values(tmp_path, sensor):
    codes = np.array([[0, 255], [255, 0]], dtype=np.uint8)[..., None].repeat(3, axis=2)
    checks = write_image(tmp_path / "checks.png", codes)
    assert_allclose(read_picture(checks, sensor, max_side=1).rgb, 0.5)


@pytest.mark.parametrize(
    "encoding", [texture.Spectrum(), texture.Moments(), texture.Multipliers()]
)
def test_pixels_of_an_entry_outside_the_space_have_its_spectrum(
    encoding, cyan_cube, to_texture
):
    """In the core of its box; near it they are between the entry and the mapped
    colour.
    """
    data = cyan_cube.data
    boxes = data.outside_boxes
    shift = boxes.half_width[0] * np.array([0, 1, 0])
    pixels = np.stack([boxes.rgb[0] + by * shift for by in (0, 0.55, 2)])[None]
    space = find_space("P3-D65")
    wide = pixels @ np.linalg.inv(space.matrix_to(data.sensor)).T
    uplifter = texture.prepare(cyan_cube, encoding, depth="float", space="P3-D65")
    result = to_texture(planes(wide.astype(np.float32)), uplifter)
    near, far = map_to_gamut(pixels[0, 1:], data.sensor, "clip").rgb
    colours = rgb_of(result)[0]
    expected = [boxes.rgb[0], (boxes.rgb[0] + near) / 2, far]
    assert_allclose(colours, expected, rtol=0, atol=1e-5)
    assert result.counts["pixels-out-of-gamut"] == 2
    numbers = read_channels(result.target, uplifter.channels)[0]
    found = spectra_by(numbers, encoding, cyan_cube)
    assert_allclose(data.sensor.rgb(found), colours, rtol=0, atol=1e-3)
    if isinstance(encoding, texture.Spectrum):
        spectra = data.atlas.outside.spectra
        entry = spectra.reflectance(np.array([0]), cyan_cube.wavelengths)[0]
        assert_allclose(found[0], entry, rtol=0, atol=1e-4)
