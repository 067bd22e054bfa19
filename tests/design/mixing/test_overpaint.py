"""Coats over images: the plain way beside the banded one, and what else is in the file."""

from __future__ import annotations

import json

import numpy as np
import OpenEXR
import pytest

from tests.io.texture.conftest import channels, held, planes, write_exr
from uplift.common.errors import ColourError, OptionError, OutputError, TextureError
from uplift.design.mixing import coats, overpaint


@pytest.fixture(scope="module")
def glaze(small_cube):
    """Half a unit of the ColorChecker's red in oil."""
    from uplift.design.mixing import surface

    atlas = small_cube.data.atlas
    seen = small_cube.reflectance(atlas.rgb[atlas.names.index("red")])
    face = surface.perpendicular(1.5)
    return coats.of_paints(coats.palette([coats.paint(seen, surface=face)]), [1], 0.5, face)


@pytest.fixture(scope="module")
def brush(small_cube, glaze):
    return overpaint.ready(small_cube, glaze, {"of": "red"}, threads=1)


@pytest.fixture
def image():
    return np.random.default_rng(1).random((6, 5, 3)).astype(np.float32)


def test_pixels_are_uplifted_painted_and_seen(small_cube, glaze, brush, image):
    expected = small_cube.data.sensor.rgb(glaze.over(small_cube.reflectance(image)))
    np.testing.assert_allclose(brush.over(image), expected, atol=2e-6)


def test_an_exr_comes_out_with_all_its_channels(brush, image, tmp_path):
    alpha = np.linspace(0, 1, 30, dtype=np.float16).reshape(6, 5)
    write_exr(tmp_path / "in.exr", {**planes(image), "A": alpha})
    painted = overpaint.paint_over(brush, tmp_path / "in.exr", tmp_path / "out.exr")
    assert (painted.counts.pixels, painted.moved, painted.remarks) == (30, 0, ())
    np.testing.assert_array_equal(held(tmp_path / "out.exr", "RGB"), brush.over(image))
    found = channels(tmp_path / "out.exr")
    assert found["R"].dtype == np.float32
    np.testing.assert_array_equal(found["A"], alpha)
    header = OpenEXR.File(str(tmp_path / "out.exr"), separate_channels=True).header()
    assert json.loads(header["uplift.mix"]) == {"of": "red"}


def test_codes_are_decoded(small_cube, brush, tmp_path):
    import matplotlib.image

    codes = np.random.default_rng(2).integers(0, 256, (4, 5, 3), dtype=np.uint8)
    matplotlib.image.imsave(tmp_path / "in.png", codes)
    overpaint.paint_over(brush, tmp_path / "in.png", tmp_path / "out.exr")
    expected = brush.over(small_cube.decode(codes).astype(np.float32))
    np.testing.assert_allclose(held(tmp_path / "out.exr", "RGB"), expected, atol=1e-6)


def test_hiding_paint_leaves_nothing_to_see(small_cube, image):
    seen = small_cube.reflectance([0.3, 0.2, 0.1])
    thick = overpaint.ready(small_cube, coats.of_paints(coats.palette([coats.paint(seen)]), [1]), threads=1)
    np.testing.assert_allclose(thick.over(image), np.broadcast_to([0.3, 0.2, 0.1], image.shape), atol=1e-5)


def test_no_paint_leaves_the_painting(small_cube, image):
    seen = small_cube.reflectance([0.3, 0.2, 0.1])
    none = coats.of_paints(coats.palette([coats.paint(seen)]), [1], 0.0)
    np.testing.assert_allclose(overpaint.ready(small_cube, none, threads=1).over(image), image, atol=1e-5)


def test_pixels_outside_are_moved_before_and_after_and_that_is_said(small_cube, image, tmp_path):
    """A dye is as saturated as it is thick."""
    seen = small_cube.reflectance([[0.9, 0.1, 0.02]])
    dye = coats.of_dyes(seen, [1], 3.0)
    write_exr(tmp_path / "in.exr", planes(image + 0.5))
    brush = overpaint.ready(small_cube, dye, threads=1)
    painted = overpaint.paint_over(brush, tmp_path / "in.exr", tmp_path / "out.exr")
    assert 0 < painted.counts.outside < 30
    assert painted.moved > 0
    first, second = painted.remarks
    assert f"{painted.counts.outside} of 30 pixels lie outside [0, 1]: scaled" in first
    assert second == f"{painted.moved} painted pixels lie outside [0, 1]: scaled"
    found = held(tmp_path / "out.exr", "RGB")
    assert ((found >= 0) & (found <= 1)).all()
    strict = overpaint.ready(small_cube, dye, out_of_gamut="error", threads=1)
    with pytest.raises(ColourError, match=r"in\.exr: linear RGB"):
        overpaint.paint_over(strict, tmp_path / "in.exr", tmp_path / "strict.exr")
    assert not (tmp_path / "strict.exr").exists()


def test_bad_input(small_cube, glaze, brush, image, tmp_path):
    with pytest.raises(OptionError, match="encoding"):
        overpaint.ready(small_cube, glaze, encoding="srgb")
    with pytest.raises(OptionError, match="out of gamut"):
        overpaint.ready(small_cube, glaze, out_of_gamut="away")
    with pytest.raises(TextureError, match="no such file"):
        overpaint.paint_over(brush, tmp_path / "none.exr", tmp_path / "out.exr")
    write_exr(tmp_path / "in.exr", planes(image))
    with pytest.raises(OutputError, match="exists already"):
        overpaint.paint_over(brush, tmp_path / "in.exr", tmp_path / "in.exr")
    write_exr(tmp_path / "z.exr", {"Z": image[..., 0]})
    with pytest.raises(TextureError, match="holds no colour"):
        overpaint.paint_over(brush, tmp_path / "z.exr", tmp_path / "out.exr")
    assert not (tmp_path / "out.exr").exists()
