"""Conversion of images of all types: decoding, gamut mapping, channels that pass through, and warnings."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from tests.helpers import raises
from tests.io.texture.conftest import WAVELENGTHS, channels, planes, read_channels, small_tiles, write_exr
from uplift.colorimetry.gamut import map_to_gamut
from uplift.common.errors import ColourError, TextureError
from uplift.common.progress import Progress
from uplift.io import texture

SIZE = (12, 17)


@pytest.fixture
def codes():
    return np.random.default_rng(1).integers(0, 256, (*SIZE, 4), dtype=np.uint8)


@pytest.fixture
def convert_image(spectral, tmp_path):
    """Function that converts an image and returns the outcome and the texture's channels."""

    def convert(source, uplifter=spectral):
        result = texture.convert(uplifter, source, tmp_path / "made.exr", force=True)
        return result, channels(tmp_path / "made.exr")

    return convert


def rgb_of(found):
    return np.stack([found[letter] for letter in "RGB"], axis=-1)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "interlaced.png", "palette.png"])
def test_8_bit_images_are_decoded(name, codes, convert_image, small_cube, tmp_path):
    image = Image.fromarray(codes[..., :3])
    if name == "palette.png":
        image = image.quantize(16)
    image.save(tmp_path / name)
    expected = small_cube.decode(np.asarray(image.convert("RGB"), dtype=float))
    _, found = convert_image(tmp_path / name)
    np.testing.assert_allclose(rgb_of(found), expected, rtol=0, atol=1e-7)


def test_grey_and_alpha(codes, convert_image, small_cube, tmp_path):
    Image.fromarray(codes[..., [0, 3]], "LA").save(tmp_path / "grey.png")
    _, found = convert_image(tmp_path / "grey.png")
    grey = small_cube.decode(codes[..., 0].astype(float))
    np.testing.assert_allclose(rgb_of(found), np.stack([grey] * 3, axis=-1), rtol=0, atol=1e-7)
    assert found["A"].dtype == np.float16
    np.testing.assert_array_equal(np.rint(found["A"] * 255.0), codes[..., 3])
    assert "Y" not in found


@pytest.mark.parametrize("suffix", ["png", "tif"])
def test_16_bits_stay_16_bits(suffix, convert_image, tmp_path):
    """Against the curve of the standard, for every code of a ramp finer than 8 bits."""
    import OpenImageIO

    codes = np.arange(0, 65536, 129, dtype=np.uint16)[:504].reshape(21, 24)
    rgba = np.stack([codes, codes[::-1], codes[:, ::-1], codes], axis=-1)
    image = OpenImageIO.ImageOutput.create(suffix)
    spec = OpenImageIO.ImageSpec(24, 21, 4, "uint16")
    spec.attribute("oiio:UnassociatedAlpha", 1)
    assert image.open(str(tmp_path / f"a.{suffix}"), spec)
    assert image.write_image(np.ascontiguousarray(rgba))
    image.close()
    _, found = convert_image(tmp_path / f"a.{suffix}")
    share = rgba[..., :3] / 65535
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    assert np.abs(rgb_of(found) - linear).max() < 8e-6  # half a code
    np.testing.assert_array_equal(np.rint(found["A"] * 65535.0), rgba[..., 3])


def test_floats_are_linear_unless_the_encoding_is_given(colours, convert_image, small_cube, spectral, tmp_path):
    Image.fromarray(colours[..., 0]).save(tmp_path / "float.tif")
    _, found = convert_image(tmp_path / "float.tif")
    np.testing.assert_array_equal(found["R"], colours[..., 0])
    encoded = texture.prepare(small_cube, texture.Moments(), encoding="encoded", threads=1)
    _, found = convert_image(tmp_path / "float.tif", encoded)
    np.testing.assert_allclose(found["R"], small_cube.decode(255.0 * colours[..., 0]), rtol=0, atol=1e-6)
    Image.fromarray((colours * 255).astype(np.uint8)).save(tmp_path / "linear.png")
    linear = texture.prepare(small_cube, texture.Moments(), encoding="linear", threads=1)
    _, found = convert_image(tmp_path / "linear.png", linear)
    np.testing.assert_allclose(rgb_of(found), (colours * 255).astype(np.uint8) / 255, rtol=0, atol=1e-7)


def test_only_invalid_pixels_are_clamped_and_counted(colours, convert_image, spectral, tmp_path):
    bad = colours.copy()
    bad[1, 1] = np.nan
    bad[2, 2] = (np.inf, 0.5, -np.inf)
    bad[3, 3] = (-0.25, 0.5, 2)
    bad[4, 4, 0] = -1e-3
    result, found = convert_image(write_exr(tmp_path / "bad.exr", planes(bad)))
    assert result.counts == texture.Counts(pixels=600, outside=2, not_finite=2, max_change=1)
    assert [warning.code for warning in result.warnings] == ["pixels-out-of-gamut", "pixels-not-finite"]
    assert [warning.path for warning in result.warnings] == [tmp_path / "bad.exr"] * 2
    assert "2 of 600 pixels" in result.warnings[0].problem
    assert "by up to 1" in result.warnings[0].problem
    assert "2 of 600 pixels" in result.warnings[1].problem
    good = np.clip(np.nan_to_num(bad, nan=0, posinf=1, neginf=0), 0, 1)
    assert good[1, 1].tolist() == [0, 0, 0]
    assert good[2, 2].tolist() == [1, 0.5, 0]
    np.testing.assert_array_equal(rgb_of(found), good)
    spectra = np.stack([found[name] for name in spectral.channels], axis=-1)
    np.testing.assert_allclose(spectra, spectral.cube.reflectance(good, WAVELENGTHS), atol=1e-6)
    result, _ = convert_image(write_exr(tmp_path / "good.exr", planes(good)))
    assert result.warnings == ()


@pytest.mark.parametrize(
    ("method", "past_tense"),
    [("scale", "scaled"), ("desaturate", "desaturated"), ("desaturate-oklab", "desaturated in Oklab")],
)
def test_pixels_outside_are_mapped_by_the_method(method, past_tense, colours, convert_image, spectral, tmp_path):
    bad = colours.copy()
    bad[3, :5] = np.array([[-0.25, 0.5, 2], [8, 4, 1], [0.2, 0.6, -0.1], [-1, -1, -1], [7, 7, 7]])
    bad[4, 4] = (np.inf, 5, np.nan)
    source = write_exr(tmp_path / "bad.exr", planes(bad))
    result, found = convert_image(source, replace(spectral, out_of_gamut=method))
    bad[4, 4] = (1, 1, 0)
    moved = map_to_gamut(bad, spectral.cube.data.sensor, method)
    np.testing.assert_array_equal(rgb_of(found), moved.rgb)
    assert result.counts == texture.Counts(600, outside=5, not_finite=1, max_change=moved.max_change)
    first = result.warnings[0]
    assert first.code == "pixels-out-of-gamut"
    assert "5 of 600 pixels" in first.problem
    assert f": {past_tense}, a component by up to {moved.max_change:.3g}" in first.problem


@pytest.mark.parametrize("bad", [1.5, -0.5, np.nan])
def test_pixels_outside_can_be_an_error(bad, colours, spectral, tmp_path):
    strict = replace(spectral, out_of_gamut="error")
    good = write_exr(tmp_path / "good.exr", planes(colours))
    texture.convert(strict, good, tmp_path / "out.exr")
    rgb = colours.copy()
    rgb[3, 3, 0] = bad
    source = write_exr(tmp_path / "bad.exr", planes(rgb))
    with pytest.raises(ColourError) as caught:
        texture.convert(strict, source, tmp_path / "bad-out.exr")
    assert caught.value.path == source
    assert f"({bad:g}, " in caught.value.problem
    assert not (tmp_path / "bad-out.exr").exists()


def other_planes(shape):
    """Return a mask, a depth with NaN and infinity, and object numbers."""
    rng = np.random.default_rng(3)
    depth = rng.normal(0, 1e6, shape).astype(np.float32)
    depth[0, :3] = (np.nan, np.inf, -np.inf)
    return {
        "mask": rng.random(shape).astype(np.float16),
        "Z": depth,
        "id": rng.integers(0, 1 << 24, shape, dtype=np.uint32, endpoint=True),
    }


@pytest.mark.parametrize("kind", [OpenEXR.scanlineimage, OpenEXR.tiledimage])
@pytest.mark.parametrize("band", [1, 1 << 25])
def test_several_parts_tiles_windows_and_other_channels(kind, band, spectral, tmp_path, monkeypatch):
    monkeypatch.setattr("uplift.io.texture.image.MAX_BAND_BYTES", band)
    shape = (70, 45)
    rgb = np.random.default_rng(2).random((*shape, 3)).astype(np.float16)
    others = other_planes(shape)
    tiles = {"tiles": small_tiles()} if kind == OpenEXR.tiledimage else {}
    header = {
        "type": kind,
        "dataWindow": ((5, -7), (5 + shape[1] - 1, -7 + shape[0] - 1)),
        "displayWindow": ((0, 0), (99, 79)),
        "pixelAspectRatio": 2.0,
        **tiles,
    }
    parts = [
        OpenEXR.Part({**header}, {**planes(rgb), **others}, "left"),
        OpenEXR.Part({**header}, {"deep.Z": others["Z"]}, "depth"),
        OpenEXR.Part({**header}, {f"view.{name}": plane for name, plane in planes(rgb[::-1]).items()}, "right"),
    ]
    OpenEXR.File(parts).write(str(tmp_path / "in.exr"))
    result = texture.convert(spectral, tmp_path / "in.exr", tmp_path / "out.exr")
    assert result.counts.pixels == 2 * rgb.size // 3
    written = OpenEXR.File(str(tmp_path / "out.exr"), separate_channels=True).parts
    assert [part.name() for part in written] == ["left", "depth", "right"]
    for part in written:
        assert [corner.tolist() for corner in part.header["dataWindow"]] == [[5, -7], [49, 62]]
        assert [corner.tolist() for corner in part.header["displayWindow"]] == [[0, 0], [99, 79]]
        assert part.header["pixelAspectRatio"] == 2
    for name, plane in others.items():
        pixels = written[0].channels[name].pixels
        assert pixels.dtype == plane.dtype
        np.testing.assert_array_equal(pixels, plane)
    np.testing.assert_array_equal(written[1].channels["deep.Z"].pixels, others["Z"])
    assert set(written[1].channels) == {"deep.Z"}
    for number, colours in ((0, rgb), (2, rgb[::-1])):
        found = read_channels(tmp_path / "out.exr", spectral.channels, number)
        expected = spectral.cube.reflectance(colours, WAVELENGTHS)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_integers_that_float32_cannot_hold_raise(colours, spectral, tmp_path):
    integers = {**planes(colours), "id": np.full(colours.shape[:2], (1 << 24) + 1, dtype=np.uint32)}
    source = write_exr(tmp_path / "in.exr", integers)
    with raises(TextureError) as caught:
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert caught.value.path == source
    assert "16777217 in channel 'id'" in caught.value.problem
    assert not (tmp_path / "out.exr").exists()


def test_bands_are_bounded_and_do_not_change_the_result(spectral, colours, tmp_path, monkeypatch):
    source = write_exr(tmp_path / "in.exr", planes(np.tile(colours, (5, 1, 1))))
    texture.convert(spectral, source, tmp_path / "whole.exr")
    monkeypatch.setattr("uplift.io.texture.image.MAX_BAND_BYTES", 1)
    monkeypatch.setattr("uplift.io.texture.writer.MAX_BAND_BYTES", 1)
    shapes, rows = [], []

    def sample(rgb):
        shapes.append(rgb.shape)
        return spectral.sample(rgb)

    bands = replace(spectral, sample=sample)
    texture.convert(bands, source, tmp_path / "bands.exr", progress=rows.append)
    assert (tmp_path / "bands.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    assert shapes == [(16, 30, 3)] * 6 + [(4, 30, 3)]
    assert rows[-1] == Progress("rows", 100, 100)
    assert [each.done for each in rows] == sorted({each.done for each in rows})


def layers(*names):
    return {f"{name}.{letter}": np.zeros((4, 5), np.float32) for name in names for letter in "RGB"}


@pytest.mark.parametrize(
    ("content", "value"),
    [
        ({"Z": np.zeros((4, 5), np.float32)}, "among Z"),
        (layers("diffuse", "coat"), "got coat, diffuse"),
        ({letter: np.zeros((4, 5), np.uint32) for letter in "RGB"}, "got uint"),
    ],
)
def test_images_without_a_unique_colour_raise(content, value, spectral, tmp_path):
    source = write_exr(tmp_path / "in.exr", content)
    with raises(TextureError) as caught:
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert value in caught.value.problem
    assert caught.value.path == source


def test_files_that_are_not_images_raise(spectral, colours, tmp_path):
    (tmp_path / "text.png").write_text("no image")
    Image.fromarray((colours * 255).astype(np.uint8)).save(tmp_path / "a.bmp")
    codes = {"none.png": "file-not-found", ".": "file-not-found", "text.png": "unreadable-image", "a.bmp": "texture"}
    for name, code in codes.items():
        with raises(TextureError, code) as caught:
            texture.convert(spectral, tmp_path / name, tmp_path / "out.exr")
        assert caught.value.path == tmp_path / name
    assert not (tmp_path / "out.exr").exists()


def write_statements(path):
    """Write an OpenEXR file with attributes of all types that OpenImageIO can write."""
    import OpenImageIO

    spec = OpenImageIO.ImageSpec(4, 3, 3, "half")
    for name, kind, value in (
        ("owner", "string", "a studio"),
        ("crew", "string[2]", ("Ann", "Bo")),
        ("framesPerSecond", "rational", (24000, 1001)),
        ("smpte:TimeCode", "timecode", (0x01020304, 0)),
        ("smpte:KeyCode", "keycode", (1, 2, 3, 4, 5, 4, 64)),
        ("worldToCamera", "matrix", tuple(range(16))),
        ("focus", "float", 1.5),
        ("take", "int", 3),
        ("screenWindowCenter", "float[2]", (0.25, 0.5)),
        ("colorInteropID", "string", "lin_rec709_scene"),
    ):
        spec.attribute(name, OpenImageIO.TypeDesc(kind), value)
    image = OpenImageIO.ImageOutput.create("openexr")
    assert image.open(str(path), spec)
    assert image.write_image(np.zeros((3, 4, 3), np.float32))
    image.close()


def test_statements_of_the_image_are_kept(convert_image, tmp_path):
    write_statements(tmp_path / "a.exr")
    result, _ = convert_image(tmp_path / "a.exr")
    before, after = (OpenEXR.File(str(path)).header() for path in (result.source, result.target))
    assert before.keys() - after.keys() == {"colorInteropID"}
    assert before["framesPerSecond"] == Fraction(24000, 1001)
    for name in (
        *("owner", "crew", "framesPerSecond", "timeCode", "keyCode"),
        *("worldToCamera", "focus", "take", "screenWindowCenter"),
    ):
        np.testing.assert_array_equal(after[name], before[name], err_msg=name)
