"""Painting over images: the banded conversion agrees with a direct computation, other channels pass through."""

from __future__ import annotations

import json

import numpy as np
import OpenEXR
import pytest

from tests.helpers import raises
from tests.io.texture.conftest import channels, planes, read_channels, write_exr
from uplift.common.errors import ColourError, OptionError, TextureError
from uplift.design.mixing import Ingredients, Medium, Surface, make_coat
from uplift.design.mixing import overpainter as make_overpainter
from uplift.design.mixing.pigments import SQUARE_ROOT
from uplift.io.texture import convert


@pytest.fixture(scope="module")
def glaze(small_cube):
    """Half a unit of the ColorChecker's red in oil."""
    atlas = small_cube.data.atlas
    red = small_cube.reflectance(atlas.rgb[atlas.names.index("red")])
    return make_coat("pigment", Ingredients(red[None]), [1], Medium(0.5, Surface.of_index(1.5), SQUARE_ROOT))


@pytest.fixture(scope="module")
def overpainter(small_cube, glaze):
    return make_overpainter(small_cube, glaze, {"of": "red"}, threads=1)


@pytest.fixture
def image():
    return np.random.default_rng(1).random((6, 5, 3)).astype(np.float32)


def test_colours_are_those_of_the_coated_spectra(small_cube, glaze, overpainter, image):
    expected = small_cube.data.sensor.rgb(glaze.over(small_cube.reflectance(image)))
    np.testing.assert_allclose(overpainter.paint(image), expected, atol=2e-6)


def test_other_channels_of_an_exr_pass_through(overpainter, image, tmp_path):
    mask = np.linspace(0, 1, 30, dtype=np.float16).reshape(6, 5)
    write_exr(tmp_path / "in.exr", {**planes(image), "mask": mask})
    result = convert(overpainter, tmp_path / "in.exr", tmp_path / "out.exr")
    assert (result.counts.pixels, result.counts.painted_outside, result.warnings) == (30, 0, ())
    np.testing.assert_array_equal(read_channels(tmp_path / "out.exr", "RGB"), overpainter.paint(image))
    found = channels(tmp_path / "out.exr")
    assert found["R"].dtype == np.float32
    np.testing.assert_array_equal(found["mask"], mask)
    header = OpenEXR.File(str(tmp_path / "out.exr"), separate_channels=True).header()
    assert json.loads(header["uplift.mix"]) == {"of": "red"}


def test_opaque_paint_hides_the_image_and_a_coat_without_thickness_leaves_it(small_cube, image):
    paint = Ingredients(small_cube.reflectance([[0.3, 0.2, 0.1]]))
    for thickness, expected in ((None, np.broadcast_to([0.3, 0.2, 0.1], image.shape)), (0.0, image)):
        coat = make_coat("pigment", paint, [1], Medium(thickness, scattering=SQUARE_ROOT))
        np.testing.assert_allclose(make_overpainter(small_cube, coat, threads=1).paint(image), expected, atol=1e-5)


def test_pixels_outside_are_mapped_before_and_after_with_warnings(small_cube, image, tmp_path):
    """A thick dye is saturated enough to leave the gamut."""
    dye = make_coat("dye", Ingredients(small_cube.reflectance([[0.9, 0.1, 0.02]])), [1], Medium(3.0))
    write_exr(tmp_path / "in.exr", planes(image + 0.5))
    overpainter = make_overpainter(small_cube, dye, threads=1)
    result = convert(overpainter, tmp_path / "in.exr", tmp_path / "out.exr")
    assert 0 < result.counts.outside < 30
    assert result.counts.painted_outside > 0
    before, after = result.warnings
    assert before.code == "pixels-out-of-gamut"
    assert f"{result.counts.outside} of 30 pixels lie outside [0, 1]: scaled" in before.problem
    assert after.code == "painted-pixels-out-of-gamut"
    assert f"{result.counts.painted_outside} of 30 pixels lie outside [0, 1] after painting: scaled" in after.problem
    found = read_channels(tmp_path / "out.exr", "RGB")
    assert ((found >= 0) & (found <= 1)).all()
    strict = make_overpainter(small_cube, dye, out_of_gamut="error", threads=1)
    with pytest.raises(ColourError) as caught:
        convert(strict, tmp_path / "in.exr", tmp_path / "strict.exr")
    assert caught.value.path == tmp_path / "in.exr"
    assert not (tmp_path / "strict.exr").exists()


def test_invalid_input_raises(small_cube, glaze, overpainter, image, tmp_path):
    with raises(OptionError):
        make_overpainter(small_cube, glaze, encoding="srgb")
    with raises(OptionError, "unknown-gamut-mapping"):
        make_overpainter(small_cube, glaze, out_of_gamut="away")
    write_exr(tmp_path / "z.exr", {"Z": image[..., 0]})
    with raises(TextureError):
        convert(overpainter, tmp_path / "z.exr", tmp_path / "out.exr")
    assert not (tmp_path / "out.exr").exists()
