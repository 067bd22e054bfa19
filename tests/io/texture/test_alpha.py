"""Colours multiplied by alpha: divided before they are uplifted, multiplied after, in all readers. Reduced pictures."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from tests.io.texture.conftest import WAVELENGTHS, channels, planes, read_channels, write_exr, write_image
from uplift.common.errors import ColourError
from uplift.io import texture
from uplift.io.mitsuba.texture_file import read_colours
from uplift.io.scene_colours import Images
from uplift.io.texture.picture import read_picture


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


@pytest.mark.parametrize("layer", ["", "view."])
def test_spectra_are_those_of_the_divided_colours_times_alpha(layer, colours, alpha, spectral, tmp_path):
    shown = {f"{layer}{name}": plane for name, plane in {**planes(colours * alpha[..., None]), "A": alpha}.items()}
    other = {"A": np.zeros_like(alpha)} if layer else {}
    source = write_exr(tmp_path / "in.exr", {**other, **shown})
    result = texture.convert(spectral, source, tmp_path / "out.exr")
    found = read_channels(tmp_path / "out.exr", spectral.channels)
    expected = spectral.cube.reflectance(colours.astype(float), WAVELENGTHS) * alpha[..., None]
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)
    rgb = read_channels(tmp_path / "out.exr", "RGB")
    np.testing.assert_allclose(rgb, colours * alpha[..., None], rtol=0, atol=1e-6)
    np.testing.assert_array_equal(channels(tmp_path / "out.exr")[f"{layer}A"], alpha)
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
        visible, expected = alpha > 1e-3, numbers[0] * weight[..., None]
        np.testing.assert_allclose(numbers[1][visible], expected[visible], rtol=1e-3, atol=2e-3)


@pytest.mark.parametrize("is_multiplied", [True, False])
def test_tiffs_state_whether_they_are_multiplied(is_multiplied, small_cube, spectral, tmp_path):
    codes = np.array([[[100, 50, 0, 200], [200, 200, 200, 200], [0, 0, 0, 0], [9, 0, 0, 0]]], np.uint8)
    write_image(tmp_path / "a.tif", codes, **{"oiio:UnassociatedAlpha": int(not is_multiplied)})
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
    source = write_exr(tmp_path / "a.exr", {**planes(np.full((1, 6, 3), 0.75, np.float32)), "A": alpha})
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


@pytest.mark.parametrize("band", [1 << 25, 1])
@pytest.mark.parametrize("max_side", [30, 11])
def test_pictures_are_means_weighted_by_alpha(max_side, band, multiplied, colours, alpha, sensor, monkeypatch):
    monkeypatch.setattr("uplift.io.texture.image.MAX_BAND_BYTES", band)
    found, step = read_picture(multiplied, sensor, max_side=max_side), -(-30 // max_side)
    assert found.reduction == step
    for row in range(found.rgb.shape[0]):
        for column in range(found.rgb.shape[1]):
            block = np.s_[step * row : step * (row + 1), step * column : step * (column + 1)]
            weights = alpha[block][..., None]
            mean = (colours[block] * weights).sum(axis=(0, 1)) / max(weights.sum(), 1e-9)
            np.testing.assert_allclose(found.rgb[row, column], mean, rtol=0, atol=2e-6)
            np.testing.assert_allclose(found.opacity[row, column], weights.mean(), rtol=1e-5)


def test_pictures_without_alpha(tmp_path, sensor):
    codes = np.array([[0, 255], [255, 0]], dtype=np.uint8)[..., None].repeat(3, axis=2)
    found = read_picture(write_image(tmp_path / "checks.png", codes), sensor, max_side=1)
    np.testing.assert_allclose(found.rgb, 0.5)  # averaged as linear values
    path = write_exr(tmp_path / "fire.exr", planes(np.full((2, 2, 3), 2, np.float32)))
    found = read_picture(path, sensor, max_side=10)
    np.testing.assert_array_equal(found.rgb, 1)
    assert [warning.code for warning in found.warnings] == ["pixels-out-of-gamut"]
    with raises(ColourError, "rgb-out-of-gamut"):
        read_picture(path, sensor, max_side=10, out_of_gamut="error")
