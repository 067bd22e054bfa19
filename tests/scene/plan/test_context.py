"""Samples of pixels, and colours of occupied bins."""

from __future__ import annotations

import numpy as np
import pytest

from tests.io.texture.conftest import planes, write_exr
from uplift.scene.plan.context import BINS, sample_colours


@pytest.fixture
def image(tmp_path):
    """A file of linear RGB (h, w, 3)."""
    return lambda rgb, name="a.exr": write_exr(tmp_path / name, planes(np.asarray(rgb, np.float32)))


def test_small_textures_are_sampled_completely(image, sensor):
    rgb = np.array([[[0.1, 0.2, 0.3], [0.1, 0.2, 0.3], [0.5, 0.5, 0.5], [0.1, 0.2, 0.3]]])
    found = sample_colours((image(rgb), image(rgb, "b.exr")), sensor, "auto", (4, 6))
    for sample in (found.predicting, found.confirming):
        np.testing.assert_allclose(sample.rgb, [[0.1, 0.2, 0.3], [0.5, 0.5, 0.5]], rtol=1e-6)
        np.testing.assert_allclose(sample.share, [0.75, 0.25])
    assert len(found.colour_bins) == 2


def test_the_two_samples_of_a_large_texture_are_disjoint(image, sensor):
    rgb = np.random.default_rng(1).random((100, 90, 3))
    path = image(rgb)
    found = sample_colours((path,), sensor, "auto", (300, 600))
    first, second = (set(map(tuple, sample.rgb.tolist())) for sample in (found.predicting, found.confirming))
    assert not first & second
    assert 240 < len(first) < 360
    assert 500 < len(second) < 700
    assert first | second <= set(map(tuple, rgb.astype(np.float32).reshape(-1, 3).astype(float).tolist()))
    for sample in (found.predicting, found.confirming):
        assert sample.share.sum() == pytest.approx(1)
        np.testing.assert_allclose(sample.share @ sample.rgb, 0.5, atol=0.06)  # equal probability
    again = sample_colours((path,), sensor, "auto", (300, 600))
    np.testing.assert_array_equal(again.predicting.rgb, found.predicting.rgb)


def test_rare_colours_have_a_bin(image, sensor):
    rgb = np.full((80, 80, 3), 0.25)
    rgb[40, 40] = [0.9, 0.05, 0.1]
    found = sample_colours((image(rgb),), sensor, "auto", (50, 50))
    np.testing.assert_allclose(np.sort(found.colour_bins[:, 0]), [0.25, 0.9], rtol=1e-6)
    wide = sample_colours((image(np.random.default_rng(2).random((64, 64, 3))),), sensor, "auto", (50, 50))
    codes = np.interp(wide.colour_bins, sensor.decoding, np.linspace(0, BINS, 256)).astype(int)
    assert len(np.unique(codes, axis=0)) == len(codes)
