"""Alpha: colours are divided by it, spectra and moments multiplied; light without
opacity stays.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.texture.conftest import (
    WAVELENGTHS,
    channels,
    planes,
    read_channels,
    rgb_of,
    write_exr,
    write_image,
)
from uplift.extras import texture
from uplift.extras.images.picture import read_picture


@pytest.fixture
def alpha(colours):
    """Alpha (20, 30), with 0 and 1."""
    values = np.random.default_rng(4).random(colours.shape[:2]).astype(np.float32)
    values[:, :2] = [0, 1]
    return values


@pytest.fixture
def multiplied(colours, alpha, tmp_path):
    """OpenEXR file of colours multiplied by alpha."""
    return write_exr(
        tmp_path / "in.exr", {**planes(colours * alpha[..., None]), "A": alpha}
    )


@pytest.mark.parametrize("layer", ["", "view."])
def test_spectra_are_those_of_the_divided_colours_times_alpha(
    layer, colours, alpha, spectral, to_texture
):
    weight = alpha[..., None]
    stored = {**planes(colours * weight), "A": alpha}
    shown = {f"{layer}{name}": plane for name, plane in stored.items()}
    result = to_texture({"A": np.zeros_like(alpha), **shown})
    found = read_channels(result.target, spectral.channels)
    expected = spectral.cube.reflectance(colours.astype(float), WAVELENGTHS) * weight
    assert_allclose(found, expected, rtol=0, atol=2e-6)
    assert_allclose(rgb_of(result), colours * weight, rtol=0, atol=1e-6)
    assert_array_equal(channels(result.target)[f"{layer}A"], alpha)
    assert result.warnings == ()


@pytest.mark.parametrize("encoding", [texture.Moments(), texture.Multipliers()])
def test_moments_are_multiplied_and_multipliers_are_not(
    encoding, multiplied, colours, alpha, small_cube, to_texture, tmp_path
):
    solid = write_exr(tmp_path / "solid.exr", planes(colours))
    uplifter = texture.prepare(small_cube, encoding, threads=1)
    names = uplifter.channels
    opaque = read_channels(to_texture(solid, uplifter).target, names)
    found = read_channels(to_texture(multiplied, uplifter).target, names)
    if isinstance(encoding, texture.Moments):
        opaque = opaque * alpha[..., None]
    visible = alpha > 1e-3
    assert_allclose(found[visible], opaque[visible], rtol=1e-3, atol=2e-3)


@pytest.mark.parametrize(
    ("name", "dtype", "is_multiplied"),
    [
        ("a.png", np.uint8, False),
        ("a.png", np.uint16, False),
        ("a.tif", np.uint8, False),
        ("a.tif", np.uint8, True),
    ],
)
def test_alpha_of_integers_is_straight_unless_a_tiff_states_another(
    name, dtype, is_multiplied, small_cube, to_texture, tmp_path
):
    """`tests.fuzz.images` has the colours of all formats."""
    rows = [[100, 50, 0, 200], [200, 200, 200, 200], [0, 0, 0, 0], [9, 0, 0, 0]]
    codes = np.array([rows], dtype)
    straight = {"oiio:UnassociatedAlpha": int(not is_multiplied)}
    result = to_texture(write_image(tmp_path / name, codes, **straight))
    to_bytes = 255 / np.iinfo(dtype).max
    colours = codes[0, :, :3] * to_bytes
    weight = np.ones((4, 1))
    if is_multiplied:
        colours[:2] = np.rint(colours[:2] * 255 / 200)
        weight[:2] = 200 / 255
    expected = small_cube.decode(colours) * weight
    assert_allclose(rgb_of(result)[0], expected, rtol=0, atol=1e-6)
    alpha = channels(result.target)["A"][0]
    assert_allclose(alpha, codes[0, :, 3] * to_bytes / 255, rtol=3e-4)  # a half float


def test_odd_alpha_gives_finite_colours_and_warnings(spectral, to_texture, sensor):
    alpha = np.array([[0, np.nan, np.inf, 2, -1, 0.5, 1e-6]], np.float32)
    result = to_texture({**planes(np.full((1, 7, 3), 0.75, np.float32)), "A": alpha})
    assert len(result.warnings) == 2
    assert result.counts["pixels-not-finite"] == 1
    assert result.counts["pixels-out-of-gamut"] == 2  # below 0 and the colour
    assert_array_equal(channels(result.target)["A"], alpha)
    (found,) = read_channels(result.target, (*"RGB", *spectral.channels))
    assert np.isfinite(found).all()
    assert (found[[1, 4]] == 0).all()
    assert_allclose(found[3, :3], 0.375)
    light = spectral.cube.reflectance([0.75] * 3, WAVELENGTHS)
    for row in (0, 6):  # light without opacity
        assert_allclose(found[row], [0.75, 0.75, 0.75, *light], rtol=0, atol=1e-5)
    assert_allclose(read_picture(result.source, sensor, max_side=7).rgb[0, 0], 0.75)


@pytest.mark.parametrize("band", [1 << 25, 1])
def test_pictures_are_means_weighted_by_alpha(
    band, multiplied, colours, alpha, sensor, monkeypatch
):
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    found = read_picture(multiplied, sensor, max_side=11)
    assert found.reduction == 3
    assert found.rgb.shape == (7, 10, 3)
    for row, column in np.ndindex(7, 10):
        block = np.s_[3 * row : 3 * row + 3, 3 * column : 3 * column + 3]
        weights = alpha[block][..., None]
        mean = (colours[block] * weights).sum(axis=(0, 1)) / weights.sum()
        assert_allclose(found.rgb[row, column], mean, rtol=0, atol=2e-6)
        assert_allclose(found.opacity[row, column], weights.mean(), rtol=1e-5)


def test_floats_leave_the_unit_interval_by_rounding_only(to_texture, tmp_path):
    near = np.array([[[1 + 2.0**-23, -1e-9, 0.5], [-1e-7, 1 + 5e-7, 1]]], np.float32)
    alpha = np.linspace(0.01, 1, 600).reshape(20, 30)
    white = np.repeat(alpha[..., None] * (1 + 1e-4), 3, axis=-1).astype(np.float16)
    for source in (
        planes(near),
        write_image(tmp_path / "a.tif", near),
        {**planes(white), "A": alpha.astype(np.float16)},
    ):
        assert to_texture(source).warnings == ()
    beyond = planes(near + np.float32(1e-4))
    assert to_texture(beyond).counts["pixels-out-of-gamut"] == 2
