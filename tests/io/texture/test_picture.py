"""Images as reduced arrays, against means of plain slices."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from tests.io.texture.conftest import planes, write_exr
from uplift.common.errors import ColourError
from uplift.io.texture import image as source
from uplift.io.texture.picture import read_picture


@pytest.fixture
def noise(tmp_path):
    rgb = np.random.default_rng(3).uniform(0, 1, (37, 50, 3)).astype(np.float32)
    return rgb, write_exr(tmp_path / "noise.exr", planes(rgb))


@pytest.mark.parametrize("band", [1 << 25, 1])
def test_larger_images_are_averaged(noise, sensor, band, monkeypatch):
    monkeypatch.setattr(source, "MAX_BAND_BYTES", band)
    rgb, path = noise
    found = read_picture(path, sensor, max_side=20)
    assert (found.reduction, found.rgb.shape) == (3, (13, 17, 3))
    for row in range(13):
        for column in range(17):
            block = rgb[3 * row : 3 * row + 3, 3 * column : 3 * column + 3]
            np.testing.assert_allclose(found.rgb[row, column], block.mean(axis=(0, 1)), rtol=1e-6)


def test_encoded_integers_are_averaged_as_linear_values(tmp_path, sensor):
    from PIL import Image

    codes = np.array([[0, 255], [255, 0]], dtype=np.uint8)[..., None].repeat(3, axis=2)
    Image.fromarray(codes).save(tmp_path / "checks.png")
    found = read_picture(tmp_path / "checks.png", sensor, max_side=1)
    np.testing.assert_allclose(found.rgb, 0.5)


def test_colours_outside_are_mapped_with_a_warning_or_refused(tmp_path, sensor):
    path = write_exr(tmp_path / "fire.exr", planes(np.full((2, 2, 3), 2, np.float32)))
    found = read_picture(path, sensor, max_side=10)
    np.testing.assert_array_equal(found.rgb, 1)
    assert [warning.code for warning in found.warnings] == ["pixels-out-of-gamut"]
    with raises(ColourError, "rgb-out-of-gamut"):
        read_picture(path, sensor, max_side=10, out_of_gamut="error")
