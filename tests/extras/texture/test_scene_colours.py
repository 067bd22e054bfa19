"""Cubes built for a scene: the answers of the complete cube to its colours, and errors
for all others.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from tests.conftest import ATLASES, MACBETH
from tests.extras.texture.conftest import PHOTO, WAVELENGTHS, planes, write_exr
from tests.helpers import near_black, quiet_build, raises, with_absent_points
from uplift.common.errors import ColourError
from uplift.cube.file import digest
from uplift.extras.report.rebuild import rebuild
from uplift.extras.report.regression import compare_rebuilt
from uplift.extras.texture.scene_colours import Images
from uplift.lattice.point_table import Status
from uplift.lookup import bulk
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES


@pytest.fixture(scope="module")
def scene_cube():
    """The ColorChecker at dim 32, for the colours of a photograph only."""
    return quiet_build(MACBETH, dim=32, debug=True, scene=PHOTO)


@pytest.fixture(scope="module")
def photo_colours(scene_cube):
    """(n, 3) distinct linear RGB of the photograph, as read by Pillow."""
    codes = np.asarray(Image.open(PHOTO)).reshape(-1, 3)
    return scene_cube.decode(np.unique(codes, axis=0)[::5])


def test_points_are_those_of_the_complete_cube(scene_cube, macbeth_cube):
    part = scene_cube.data
    whole = macbeth_cube.data
    there = part.points.present
    assert 0 < there.sum() < 0.3 * len(there)
    for name in (
        "coefficients",
        "rgb",
        "distance",
        "status",
        "entry",
        "round",
        "standard_error",
    ):
        array = getattr(part.points, name)
        assert_allclose(
            array[there],
            getattr(whole.points, name)[there],
            rtol=0,
            atol=1e-4,
            err_msg=name,
        )
        absent = {"status": Status.ABSENT, "entry": -1, "round": -1}.get(name, 0)
        assert (array[~there] == absent).all(), name


ANSWERS = [
    *(
        lambda cube, rgb, mode=mode: cube.reflectance(rgb, WAVELENGTHS, mode)
        for mode in MODES
    ),
    Cube.coefficients,
    Cube.standard_error,
    lambda cube, rgb: bulk.spectra(cube, WAVELENGTHS)(rgb),
    lambda cube, rgb: bulk.coefficients(cube)(rgb),
]


@pytest.mark.parametrize("answer", ANSWERS)
def test_answers_to_the_scene_are_those_of_the_complete_cube(
    scene_cube, macbeth_cube, photo_colours, answer
):
    assert scene_cube.covers(photo_colours).all()
    answers = (answer(cube, photo_colours[::10]) for cube in (scene_cube, macbeth_cube))
    assert_allclose(*answers, rtol=0, atol=1e-6)


def test_an_error_quotes_the_first_colour_that_is_not_covered(small_cube):
    cube = Cube(with_absent_points(small_cube.data, near_black(small_cube.data)))
    rgb = np.random.default_rng(3).random((500, 3))
    first, *more = rgb[~cube.covers(rgb)]
    for answer in ANSWERS:
        with raises(ColourError, "colour-not-in-scene") as caught:
            answer(cube, np.array([[0.001, 0.002, 0.003], first, *more]))
        assert ", ".join(f"{value:.6g}" for value in first) in caught.value.problem


def test_all_images_of_a_scene_are_read_and_decoded(plain_cube, tmp_path):
    data = plain_cube.data
    strange = np.array(
        [[[np.nan, 2, -1], [0, 1, 0]]], np.float32
    )  # clamped as in textures
    light = write_exr(tmp_path / "light.exr", planes(strange))
    Image.fromarray(np.full((2, 2, 3), 128, np.uint8)).save(tmp_path / "grey.png")
    for encoding, value in (("auto", plain_cube.decode(128)), ("linear", 128 / 255)):
        images = Images((light, tmp_path / "grey.png"), encoding, "clip")
        points = images.required_points(
            data.entry_boxes, data.sensor, lambda done: None
        )
        green, _ = data.lattice.corners(np.array([[0, 1, 0]]))
        low, _ = data.lattice.cell(np.full((1, 3), value))
        grey = data.lattice.cell_corners(low)  # on the edge between six tetrahedra
        assert set(grey[0]) < set(np.flatnonzero(points))
        assert set(green[0]) < set(np.flatnonzero(points))


def test_rebuild_needs_no_images(scene_cube):
    again = rebuild(scene_cube, "photo.uplift", [ATLASES])
    assert digest(again.data) == digest(scene_cube.data)
    assert compare_rebuilt("photo.uplift", scene_cube.data, again.data).failures == []
    assert again.data.provenance["scene"][0]["name"] == PHOTO.name
