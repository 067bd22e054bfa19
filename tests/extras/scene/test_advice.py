"""Advice on what to measure: variance never rises, and each swatch is the best one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ROOT
from tests.extras.texture.conftest import write_image
from tests.helpers import raises
from uplift.colorimetry.observer import light
from uplift.common.errors import TextureError
from uplift.common.progress import ignore_progress
from uplift.extras.scene.advice import advise, colour_areas, uncertainty
from uplift.extras.texture.scene_colours import Images, PixelSample, sample_colours

LIGHTS = ("A", "FL11")


@pytest.fixture(scope="module")
def cube():
    return uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")


def drawn(seed):
    rng = np.random.default_rng(seed)
    areas = rng.exponential(size=12)
    return PixelSample(rng.random((12, 3)), areas / areas.sum())


def scene(cube, colours):
    return uncertainty(cube, colours, [light(each) for each in LIGHTS])


@settings(max_examples=5)
@given(seed=st.integers(0, 1000))
def test_no_measurement_raises_a_variance_and_each_swatch_has_the_largest_gain(
    cube, seed
):
    before = scene(cube, drawn(seed))
    chosen, after = advise(before, 4)
    assert (after.errors <= before.errors + 1e-12).all()
    for swatch in chosen:
        remaining = [before.measured(each) for each in range(len(before.area))]
        gains = before.mean - np.array([each.mean for each in remaining])
        assert gains.max() == pytest.approx(swatch.gain, rel=1e-9)
        variance = np.diag(before.covariance)
        for each in remaining:
            assert (np.diag(each.covariance) <= variance + 1e-12).all()
        before = remaining[swatch.colour]
        assert np.diag(before.covariance)[swatch.colour] == pytest.approx(0, abs=1e-12)
        assert before.mean == pytest.approx(swatch.mean_after, rel=1e-12)
        assert swatch.area <= swatch.share <= 1 + 1e-12


def test_errors_are_those_of_the_cube_until_something_is_measured(cube):
    colours = drawn(0)
    before = scene(cube, colours)
    for column, name in enumerate(LIGHTS):
        # Nodes store those under one light, which are interpolated.
        tolerance = 0.05 if name == "A" else 1e-9
        expected = cube.standard_error(colours.rgb, name)
        assert_allclose(before.errors[:, column], expected, rtol=tolerance)


def test_areas_are_those_of_the_pixels(cube, tmp_path):
    pixels = np.zeros((4, 8, 3), np.uint8)
    pixels[:, :2] = (200, 60, 20)
    two = Images((write_image(tmp_path / "two.png", pixels),))
    found = colour_areas(two, cube.data.sensor)
    assert_allclose(found.share, [0.75, 0.25])
    assert_allclose(cube.encode(found.rgb[1]), (200, 60, 20), atol=1e-6)
    noise = np.random.default_rng(0).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    many = Images((write_image(tmp_path / "noise.png", noise),))
    assert len(colour_areas(many, cube.data.sensor).share) == 512
    chosen, after = advise(uncertainty(cube, found, [light("A")]), 100)
    assert len(chosen) <= 2
    assert after.mean < chosen[0].mean_after + 1e-12


@pytest.mark.parametrize(("suffix", "share"), [("png", 1), ("exr", 12 / 13)])
def test_transparent_pixels_have_no_area(cube, tmp_path, suffix, share):
    rgba = np.zeros((4, 6, 4), np.float32)
    rgba[2:] = (0.5, 0.25, 0.125, 0.5)
    rgba[0, 0] = (0.6, 0.3, 0.2, 0)  # light without opacity in OpenEXR
    values = rgba if suffix == "exr" else (rgba * 255).astype(np.uint8)
    images = Images((write_image(tmp_path / f"a.{suffix}", values),))
    sensor = cube.data.sensor
    assert colour_areas(images, sensor).share.max() == pytest.approx(share)
    samples = sample_colours(images, sensor, (99, 99), ignore_progress)
    assert samples.predicting.rgb.min() > 0
    clear = write_image(tmp_path / "clear.png", np.zeros((2, 2, 4), np.uint8))
    with raises(TextureError):
        colour_areas(Images((clear,)), sensor)
