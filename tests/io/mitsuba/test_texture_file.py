"""Textures that `uplift texture` wrote, as textures of Mitsuba."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.helpers import raises
from tests.io.texture.conftest import planes, write_exr
from uplift.common.errors import TextureError
from uplift.io import texture
from uplift.io.mitsuba.texture_file import multipliers_of_rounded, read_texels
from uplift.models import Moments

pytestmark = pytest.mark.filterwarnings("ignore:the texture calls Python:uplift.UpliftWarning")

IMAGE = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
# Two of them lie beyond the samples, and none halfway between samples that differ much.
WAVELENGTHS = np.array([362.5, 402.5, 555, 650, 823])


def flat(value, *wavelengths):
    return {f"T.{at},000000nm": np.full((2, 2), value, np.float32) for at in wavelengths}


@pytest.mark.parametrize(
    ("encoding", "mode", "within"),
    [
        (texture.Spectrum(), "spectra", 1e-3),
        (texture.Moments(), "moments", 1e-4),
        (texture.Multipliers(), "refined", 1e-5),
    ],
    ids=["spectrum", "moments", "multipliers"],
)
def test_a_texture_has_the_spectra_of_the_cube(mi, spectrum, small_cube, tmp_path, encoding, mode, within):
    write_exr(tmp_path / "image.exr", planes(IMAGE))
    uplifter = texture.prepare(small_cube, encoding, depth="float")
    texture.convert(uplifter, tmp_path / "image.exr", tmp_path / "texture.exr")
    found = mi.load_dict({"type": "uplift", "filename": str(tmp_path / "texture.exr"), "filter_type": "nearest"})
    expected = small_cube.reflectance(IMAGE[2, 1], WAVELENGTHS, mode=mode)
    np.testing.assert_allclose(spectrum(found, (0.4, 0.9), WAVELENGTHS), expected, rtol=0, atol=within)


def test_a_cube_is_not_accepted_with_a_texture(mi, cube_path, tmp_path):
    write_exr(tmp_path / "texture.exr", flat(1, 400, 500))
    with pytest.raises(RuntimeError, match="unreferenced"):
        mi.load_dict({"type": "uplift", "filename": str(tmp_path / "texture.exr"), "cube": cube_path})


def test_images_of_colours_are_not_textures(tmp_path):
    write_exr(tmp_path / "image.exr", planes(IMAGE))
    (tmp_path / "image.png").write_bytes(b"\x89PNG")
    for name in ("image.exr", "image.png", "missing.exr"):
        assert read_texels(tmp_path / name) is None


MODEL = {"uplift.model": json.dumps(Moments(9).describe())}
GREY = {f"moment.{order:02}": np.full((2, 2), 0.5 * (order == 0), np.float32) for order in range(9)}


@pytest.mark.parametrize(
    ("channels", "header"),
    [
        (flat(1, 400, 500, 700), {}),
        (flat(1, 400), {}),
        (flat(np.nan, 400, 500), {}),
        (GREY, {}),
        (GREY, {"uplift.model": "{"}),
        (GREY, {"uplift.model": json.dumps(Moments(8).describe())}),
        ({**GREY, "moment.01": np.full((2, 2), 0.6, np.float32)}, MODEL),
        (None, MODEL),
    ],
)
def test_invalid_textures_raise(tmp_path, channels, header):
    path = write_exr(tmp_path / "texture.exr", GREY if channels is None else channels, **header)
    if channels is None:
        path.write_bytes(path.read_bytes()[:-20])
    with raises(TextureError):
        read_texels(path)


def test_moments_that_rounding_moved_outside_return():
    """A box-shaped spectrum, rounded to half precision."""
    model = Moments(9)
    moments = model.to_storage([[0, 3e4, 0, -1e4, 0, 0, 0, 0, 0]])
    rounded = moments.astype(np.float16).astype(float)
    assert not model.try_from_storage(rounded)[1].all()
    multipliers, valid = multipliers_of_rounded(model, rounded)
    assert valid.all()
    np.testing.assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=0.01)
