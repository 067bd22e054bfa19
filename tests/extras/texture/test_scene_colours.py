"""Cubes built for a scene: the answers of the complete cube to its colours, and errors
for all others.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tests.conftest import ATLASES, MACBETH
from tests.extras.texture.conftest import PHOTO, planes, write_exr
from tests.helpers import quiet_build
from uplift.cube.file import digest
from uplift.extras.report.rebuild import rebuild
from uplift.extras.report.regression import compare_rebuilt
from uplift.extras.texture.scene_colours import Images
from uplift.lattice.point_table import Status


@pytest.fixture(scope="module")
def scene_cube():
    """The ColorChecker at dim 32, for the colours of a photograph only."""
    return quiet_build(MACBETH, dim=32, debug=True, scene=PHOTO)


def test_points_are_those_of_the_complete_cube(scene_cube, macbeth_cube):
    part = scene_cube.data.points
    whole = macbeth_cube.data.points
    there = part.present
    assert 0 < there.sum() < 0.3 * len(there)
    for name in ("coefficients", "rgb", "distance", "entry", "round", "standard_error"):
        array = getattr(part, name)
        expected = getattr(whole, name)[there]
        assert_allclose(array[there], expected, rtol=0, atol=1e-4, err_msg=name)
        absent = -1 if name in ("entry", "round") else 0
        assert (array[~there] == absent).all(), name
    assert_array_equal(part.status, np.where(there, whole.status, Status.ABSENT))


def test_the_colours_of_the_photograph_are_answered(scene_cube, macbeth_cube):
    codes = np.asarray(Image.open(PHOTO)).reshape(-1, 3)
    colours = scene_cube.decode(np.unique(codes, axis=0)[::20])
    assert scene_cube.covers(colours).all()
    answers = (cube.reflectance(colours) for cube in (scene_cube, macbeth_cube))
    assert_allclose(*answers, rtol=0, atol=1e-6)


@pytest.mark.parametrize("encoding", ["auto", "linear"])
def test_all_images_of_a_scene_are_read_and_decoded(encoding, plain_cube, tmp_path):
    data = plain_cube.data
    strange = np.array([[[np.nan, 2, -1], [0, 1, 0]]], np.float32)
    light = write_exr(tmp_path / "light.exr", planes(strange))
    Image.fromarray(np.full((2, 2, 3), 128, np.uint8)).save(tmp_path / "grey.png")
    images = Images((light, tmp_path / "grey.png"), encoding, "clip")
    points = images.required_points(data.entry_boxes, data.sensor, lambda done: None)
    grey = plain_cube.decode(128) if encoding == "auto" else 128 / 255
    # Pixels outside are clamped as in textures.
    rgb = np.array([[0, 1, 0], [grey] * 3])
    assert_array_equal(points, data.entry_boxes.required_points([rgb]))


def test_rebuild_needs_no_images(scene_cube):
    again = rebuild(scene_cube, "photo.uplift", [ATLASES])
    assert digest(again.data) == digest(scene_cube.data)
    assert compare_rebuilt("photo.uplift", scene_cube.data, again.data).failures == []
    assert again.data.provenance["scene"][0]["name"] == PHOTO.name
