"""Textures that `uplift texture` wrote, as textures of Mitsuba."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.io.mitsuba.images import write_channels, write_image
from uplift.common.errors import TextureError
from uplift.io import texture
from uplift.io.mitsuba.texture_file import multipliers_of_rounded, read_texels
from uplift.models import Moments

pytestmark = pytest.mark.filterwarnings("ignore:the texture calls Python:uplift.UpliftWarning")

IMAGE = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
# Two of them lie beyond the samples, and none halfway between samples that differ much.
WAVELENGTHS = np.array([362.5, 402.5, 555, 650, 823])


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
    write_image(tmp_path / "image.exr", IMAGE)
    uplifter = texture.prepare(small_cube, encoding, depth="float")
    texture.convert(uplifter, tmp_path / "image.exr", tmp_path / "texture.exr")
    found = mi.load_dict({"type": "uplift", "filename": str(tmp_path / "texture.exr"), "filter_type": "nearest"})
    expected = small_cube.reflectance(IMAGE[2, 1], WAVELENGTHS, mode=mode)
    np.testing.assert_allclose(spectrum(found, (0.4, 0.9), WAVELENGTHS), expected, rtol=0, atol=within)


def test_a_cube_is_not_accepted_with_a_texture(mi, cube_path, tmp_path):
    write_channels(tmp_path / "texture.exr", {f"T.{at},000000nm": np.ones((2, 2)) for at in (400, 500)})
    with pytest.raises(RuntimeError, match="unreferenced"):
        mi.load_dict({"type": "uplift", "filename": str(tmp_path / "texture.exr"), "cube": cube_path})


def test_images_of_colours_are_not_textures(tmp_path):
    write_image(tmp_path / "image.exr", IMAGE)
    (tmp_path / "image.png").write_bytes(b"\x89PNG")
    for name in ("image.exr", "image.png", "missing.exr"):
        assert read_texels(tmp_path / name) is None


MODEL = json.dumps(Moments(9).describe())
GREY = {f"moment.{order:02}": np.full((2, 2), 0.5 * (order == 0)) for order in range(9)}


@pytest.mark.parametrize(
    ("channels", "header", "problem"),
    [
        ({f"T.{at},000000nm": np.ones((2, 2)) for at in (400, 500, 700)}, {}, "equidistant"),
        ({"T.400,000000nm": np.ones((2, 2))}, {}, "equidistant"),
        ({f"T.{at}nm": np.full((2, 2), np.nan) for at in (400, 500)}, {}, "finite"),
        (GREY, {}, "uplift.model"),
        (GREY, {"uplift.model": "{"}, "uplift.model"),
        (GREY, {"uplift.model": json.dumps(Moments(8).describe())}, "uplift.model"),
        ({**GREY, "moment.01": np.full((2, 2), 0.6)}, {"uplift.model": MODEL}, "no reflectance"),
    ],
)
def test_invalid_textures_raise(tmp_path, channels, header, problem):
    write_channels(tmp_path / "texture.exr", channels, **header)
    with pytest.raises(TextureError, match=problem):
        read_texels(tmp_path / "texture.exr")


def test_damaged_textures_raise(tmp_path):
    write_channels(tmp_path / "texture.exr", GREY)
    content = (tmp_path / "texture.exr").read_bytes()
    (tmp_path / "texture.exr").write_bytes(content[:-20])
    with pytest.raises(TextureError, match="damaged"):
        read_texels(tmp_path / "texture.exr")


def test_moments_that_rounding_moved_outside_return():
    """A box-shaped spectrum, rounded to half precision."""
    model = Moments(9)
    moments = model.to_storage([[0, 3e4, 0, -1e4, 0, 0, 0, 0, 0]])
    rounded = moments.astype(np.float16).astype(float)
    assert not model.try_from_storage(rounded)[1].all()
    multipliers, valid = multipliers_of_rounded(model, rounded)
    assert valid.all()
    np.testing.assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=0.01)
