"""Colours multiplied by alpha: divided before they are uplifted, multiplied after, in all readers of images."""

from __future__ import annotations

import numpy as np
import OpenImageIO
import pytest

from tests.io.texture.conftest import WAVELENGTHS, channels, planes, read_channels, write_exr
from uplift.io import texture
from uplift.io.mitsuba.texture_file import read_colours
from uplift.io.scene_colours import Images
from uplift.io.texture.colours import ColourChannels
from uplift.io.texture.picture import read_picture

CHANNELS = ColourChannels((0, 1, 2), 3)


@pytest.fixture
def alpha(colours):
    """Alpha (20, 30), with 0 and 1."""
    found = np.random.default_rng(4).random(colours.shape[:2]).astype(np.float32)
    found[:, 0], found[:, 1] = 0, 1
    return found


@pytest.fixture
def multiplied(colours, alpha, tmp_path):
    """OpenEXR file of colours multiplied by alpha."""
    return write_exr(tmp_path / "in.exr", {**planes(colours * alpha[..., None]), "A": alpha})


def by_opacity(numbers, alpha):
    return numbers * alpha[..., None]


def test_spectra_are_those_of_the_divided_colours_times_alpha(multiplied, colours, alpha, spectral, tmp_path):
    result = texture.convert(spectral, multiplied, tmp_path / "out.exr")
    found = read_channels(tmp_path / "out.exr", spectral.channels)
    expected = by_opacity(spectral.cube.reflectance(colours.astype(float), WAVELENGTHS), alpha)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)
    np.testing.assert_allclose(
        read_channels(tmp_path / "out.exr", "RGB"), by_opacity(colours, alpha), rtol=0, atol=1e-6
    )
    np.testing.assert_array_equal(channels(tmp_path / "out.exr")["A"], alpha)
    assert (found[:, 0] == 0).all()
    assert result.warnings == ()


def test_moments_are_multiplied_and_multipliers_are_not(multiplied, colours, alpha, small_cube, tmp_path):
    solid = write_exr(tmp_path / "solid.exr", planes(colours))
    for encoding, weight in ((texture.Moments(), alpha), (texture.Multipliers(), np.where(alpha > 0, 1, 0))):
        uplifter = texture.prepare(small_cube, encoding, threads=1)
        numbers = []
        for source in (solid, multiplied):
            texture.convert(uplifter, source, tmp_path / "out.exr", force=True)
            numbers.append(read_channels(tmp_path / "out.exr", uplifter.channels))
        visible = alpha > 1e-3
        np.testing.assert_allclose(numbers[1][visible], by_opacity(numbers[0], weight)[visible], rtol=1e-3, atol=2e-3)


def test_alpha_of_a_layer_counts(colours, alpha, spectral, tmp_path):
    rgb = by_opacity(colours, alpha)
    layer = {f"view.{name}": plane for name, plane in {**planes(rgb), "A": alpha}.items()}
    write_exr(tmp_path / "a.exr", {**layer, "A": np.zeros_like(alpha)})
    texture.convert(spectral, tmp_path / "a.exr", tmp_path / "out.exr")
    found = read_channels(tmp_path / "out.exr", spectral.channels)
    expected = by_opacity(spectral.cube.reflectance(colours.astype(float), WAVELENGTHS), alpha)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)


@pytest.mark.parametrize("is_multiplied", [True, False])
def test_tiffs_state_whether_they_are_multiplied(is_multiplied, small_cube, spectral, tmp_path):
    codes = np.array([[[100, 50, 0, 200], [200, 200, 200, 200], [0, 0, 0, 0], [9, 0, 0, 0]]], np.uint8)
    spec = OpenImageIO.ImageSpec(4, 1, 4, "uint8")
    spec.attribute("oiio:UnassociatedAlpha", int(not is_multiplied))
    image = OpenImageIO.ImageOutput.create("tiff")
    assert image.open(str(tmp_path / "a.tif"), spec)
    assert image.write_image(codes)
    image.close()
    texture.convert(spectral, tmp_path / "a.tif", tmp_path / "out.exr")
    found = read_channels(tmp_path / "out.exr", "RGB")[0]
    straight = codes[0, :, :3].astype(float)
    expected = small_cube.decode(straight)
    if is_multiplied:
        expected = small_cube.decode(np.rint(straight[:2] * 255 / 200)) * 200 / 255
        expected = np.concatenate([expected, np.zeros((2, 3))])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)
    np.testing.assert_array_equal(np.rint(channels(tmp_path / "out.exr")["A"][0] * 255.0), codes[0, :, 3])


def test_half_floats_leave_the_unit_interval_by_rounding_only(spectral, tmp_path):
    alpha = np.linspace(0.01, 1, 600).reshape(20, 30)
    white = np.repeat(alpha[..., None] * (1 + 1e-4), 3, axis=-1).astype(np.float16)
    source = write_exr(tmp_path / "a.exr", {**planes(white), "A": alpha.astype(np.float16)})
    assert texture.convert(spectral, source, tmp_path / "out.exr").warnings == ()


def test_odd_alpha_gives_finite_colours_and_warnings(spectral, tmp_path):
    alpha = np.array([[0, np.nan, np.inf, 2, -1, 0.5]], np.float32)
    rgb = np.full((1, 6, 3), 0.75, np.float32)
    source = write_exr(tmp_path / "a.exr", {**planes(rgb), "A": alpha})
    result = texture.convert(spectral, source, tmp_path / "out.exr")
    assert {each.code for each in result.warnings} == {"pixels-not-finite", "pixels-out-of-gamut"}
    assert (result.counts.not_finite, result.counts.outside) == (2, 2)  # alpha 0 and NaN; below 0 and the colour
    found = read_channels(tmp_path / "out.exr", (*"RGB", *spectral.channels))
    assert np.isfinite(found).all()
    assert (found[0, [0, 1, 4]] == 0).all()
    np.testing.assert_allclose(found[0, 3, :3], 0.375)
    np.testing.assert_array_equal(channels(tmp_path / "out.exr")["A"], alpha)


def test_scenes_and_mitsuba_read_the_divided_colours(multiplied, colours, alpha, sensor):
    expected = np.where(alpha[..., None] > 0, colours, 0)
    found = np.concatenate(list(Images((multiplied,)).colours(multiplied, sensor)))
    np.testing.assert_allclose(found.reshape(expected.shape), expected, rtol=0, atol=1e-6)
    np.testing.assert_allclose(read_colours(multiplied, sensor, "clip")[0], expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("max_side", [30, 10])
def test_pictures_weigh_colours_by_alpha(max_side, multiplied, colours, alpha, sensor):
    found = read_picture(multiplied, sensor, max_side=max_side)
    step = 30 // max_side
    for row in range(found.rgb.shape[0]):
        for column in range(found.rgb.shape[1]):
            block = np.s_[step * row : step * (row + 1), step * column : step * (column + 1)]
            weights = alpha[block][..., None]
            mean = (colours[block] * weights).sum(axis=(0, 1)) / max(weights.sum(), 1e-9)
            np.testing.assert_allclose(found.rgb[row, column], mean, rtol=0, atol=2e-6)
            np.testing.assert_allclose(found.opacity[row, column], weights.mean(), rtol=1e-5)
