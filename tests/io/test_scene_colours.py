"""Cubes built for a scene: the answers of the complete cube to its colours, and errors for all others."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import uplift
from tests.conftest import ATLASES, MACBETH
from tests.helpers import raises, warns
from tests.io.texture.conftest import PHOTO, WAVELENGTHS, planes, write_exr
from tests.sparse_cubes import near_black, with_absent_points
from uplift.colorimetry.gamut import Primaries, conversion
from uplift.common.errors import ColourError, CubeFileError, OptionError, TextureError, UpliftWarning
from uplift.cube import AtlasTable, digest
from uplift.io.scene_colours import Images, cells_touched
from uplift.lattice import Status
from uplift.lookup import MODES, Cube, bulk
from uplift.lookup.interpolate import around
from uplift.pipeline.rebuild import rebuild
from uplift.report.regression import compare_rebuilt


@pytest.fixture(scope="module")
def scene_cube():
    """The ColorChecker at dim 32, for the colours of a photograph only."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return uplift.build(MACBETH, dim=32, debug=True, scene=PHOTO)


@pytest.fixture(scope="module")
def photo_colours(scene_cube):
    """(n, 3) distinct linear RGB of the photograph, as read by Pillow."""
    codes = np.asarray(Image.open(PHOTO)).reshape(-1, 3)
    return scene_cube.decode(np.unique(codes, axis=0)[::5])


def points_of(cube, *paths, encoding="auto", out_of_gamut="clip"):
    data = cube.data
    return Images(paths, encoding, out_of_gamut).required_points(data.entry_boxes, data.sensor, lambda done: None)


def test_images_in_another_space_are_converted(small_cube, tmp_path):
    display_p3 = (0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329)
    rgb = np.broadcast_to(np.array([0.6, 0.3, 0.2], "f4"), (2, 2, 3))
    path = write_exr(tmp_path / "a.exr", planes(rgb), chromaticities=display_p3)
    plain = write_exr(tmp_path / "b.exr", planes(rgb))
    sensor = small_cube.data.sensor
    (found,) = Images((path,)).colours(path, sensor)
    expected = conversion(Primaries.of(display_p3), sensor) @ rgb[0, 0]
    np.testing.assert_allclose(found[0], expected, rtol=0, atol=1e-6)
    (named,) = Images((plain,), space="lin_p3d65").colours(plain, sensor)
    np.testing.assert_allclose(named, found, rtol=0, atol=1e-5)
    assert Images((plain,), space="lin_p3d65").describe()[0]["space"] == "lin_p3d65"


def test_points_are_those_of_the_complete_cube(scene_cube, macbeth_cube):
    part, whole = scene_cube.data, macbeth_cube.data
    there = part.points.present
    assert 0 < there.sum() < 0.3 * len(there)
    for name in ("coefficients", "rgb", "distance", "status", "entry", "round", "standard_error"):
        array = getattr(part.points, name)
        np.testing.assert_allclose(array[there], getattr(whole.points, name)[there], rtol=0, atol=1e-9, err_msg=name)
        absent = {"status": Status.ABSENT, "entry": -1, "round": -1}.get(name, 0)
        assert (array[~there] == absent).all(), name


ANSWERS = [
    *(lambda cube, rgb, mode=mode: cube.reflectance(rgb, WAVELENGTHS, mode) for mode in MODES),
    lambda cube, rgb: cube.coefficients(rgb),
    lambda cube, rgb: cube.standard_error(rgb),
    lambda cube, rgb: cube.reflectance(rgb, WAVELENGTHS, threads=2),
    lambda cube, rgb: bulk.spectra(cube, WAVELENGTHS)(rgb),
    lambda cube, rgb: bulk.coefficients(cube)(rgb),
]


@pytest.mark.parametrize("answer", ANSWERS)
def test_answers_to_the_scene_are_those_of_the_complete_cube(scene_cube, macbeth_cube, photo_colours, answer):
    assert scene_cube.covers(photo_colours).all()
    answers = (answer(cube, photo_colours[::10]) for cube in (scene_cube, macbeth_cube))
    np.testing.assert_allclose(*answers, rtol=0, atol=1e-9)


def colours_not_covered(cube):
    """Linear RGB (n, 3) that the cube cannot answer."""
    rgb = np.random.default_rng(3).random((500, 3))
    return rgb[~cube.covers(rgb)]


@pytest.mark.parametrize("answer", ANSWERS)
def test_error_quotes_the_first_colour_that_is_not_covered(small_cube, answer):
    cube = Cube(with_absent_points(small_cube.data, near_black(small_cube.data)))
    covered, (first, *more) = np.array([0.001, 0.002, 0.003]), colours_not_covered(cube)
    with raises(ColourError, "colour-not-in-scene") as caught:
        answer(cube, np.array([covered, first, *more]))
    assert ", ".join(f"{value:.6g}" for value in first) in caught.value.problem
    assert caught.value.hint
    assert np.isfinite(answer(cube, covered[None])).all()


def colours_in(data, cell, count=400):
    """Linear RGB (count, 3) in a cell, some on its faces and corners, some at entries in it."""
    random = np.random.default_rng(cell)
    share = random.random((count, 3))
    share[: count // 2] = np.clip(np.round(share[: count // 2] * 1.5 - 0.25, 1), 0, 1 - 1e-12)
    low = data.lattice.position(np.array(cell))
    rgb = data.lattice.nodes[low] + share * (data.lattice.nodes[low + 1] - data.lattice.nodes[low])
    return rgb[(data.lattice.cell(rgb)[0] == low).all(axis=1)]


def missing(data, required):
    """Count colours that are answered from points other than those that ``required`` returns for their cell."""
    count = 0
    for cell in np.unique(data.entry_boxes.cells[0])[::3]:
        mask = np.zeros(data.lattice.size, dtype=bool)
        mask[cell] = True
        nodes = around(data, colours_in(data, cell))
        count += int((~required(mask)[nodes.points] & (nodes.weights > 0)).any(axis=1).sum())
    return count


@pytest.mark.parametrize("name", ["small_cube", "macbeth_cube"])
def test_required_points_answer_every_colour_of_a_cell(request, name):
    data = request.getfixturevalue(name).data
    assert missing(data, data.entry_boxes.required_points) == 0
    assert missing(data, data.lattice.corner_points) > 0  # entry boxes need other points than the corners


@pytest.mark.parametrize("node", [0, 3, 7])
def test_required_points_allow_for_rounding_across_faces_on_nodes(plain_cube, node):
    data = plain_cube.data
    one = AtlasTable(("one",), np.full((1, 3), data.lattice.nodes[node]), np.zeros((1, 9)), np.ones(1), np.ones(1))
    data = replace(data, atlas=one)
    assert data.entry_boxes.cells[0].size
    assert missing(data, data.entry_boxes.required_points) == 0


def test_colours_near_a_face_touch_both_cells(small_cube):
    lattice = small_cube.data.lattice
    node = lattice.nodes[3]
    touched = cells_touched(lattice, np.array([[node - 1e-8, 0.3, 0.3]]))
    assert {tuple(position) for position in lattice.position(touched)} == {
        (red, *lattice.cell(np.array([0.3, 0.3]))[0]) for red in (2, 3)
    }
    assert len(cells_touched(lattice, np.array([[node + 1e-3, 0.3, 0.3]]))) == 1


def test_all_images_of_a_scene_are_read(plain_cube, tmp_path):
    dark = write_exr(tmp_path / "a.exr", planes(np.full((4, 4, 3), 0.01, np.float32)))
    light = write_exr(tmp_path / "b.exr", planes(np.full((4, 4, 3), 0.9, np.float32)))
    both = points_of(plain_cube, dark, light)
    np.testing.assert_array_equal(both, points_of(plain_cube, dark) | points_of(plain_cube, light))


def test_images_are_decoded_by_type_or_by_the_encoding_option(plain_cube, tmp_path):
    codes = np.full((2, 2, 3), 128, np.uint8)
    Image.fromarray(codes).save(tmp_path / "grey.png")
    for encoding, value in (("auto", plain_cube.decode(128)), ("linear", 128 / 255)):
        points = points_of(plain_cube, tmp_path / "grey.png", encoding=encoding)
        corners, _ = plain_cube.data.lattice.corners(np.full((1, 3), value))
        np.testing.assert_array_equal(np.flatnonzero(points), np.sort(corners[0]))


def test_invalid_colours_are_clamped_as_in_textures(plain_cube, tmp_path):
    strange = np.array([[[np.nan, 2, -1], [0, 1, 0]]], np.float32)
    path = write_exr(tmp_path / "strange.exr", planes(strange))
    expected = write_exr(tmp_path / "clamped.exr", planes(np.array([[[0, 1, 0]] * 2], np.float32)))
    np.testing.assert_array_equal(points_of(plain_cube, path), points_of(plain_cube, expected))


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda path: None, "file-not-found"),
        (lambda path: path.write_text("not an image"), "unreadable-image"),
        (lambda path: write_exr(path, {"Z": np.ones((2, 2), np.float32)}), "texture"),
    ],
)
def test_invalid_images_are_refused(plain_cube, tmp_path, make, code):
    make(tmp_path / "image.exr")
    with raises(TextureError, code) as caught:
        points_of(plain_cube, tmp_path / "image.exr")
    assert str(tmp_path / "image.exr") in caught.value.where


def test_a_scene_without_images_is_refused():
    with raises(OptionError, "scene-without-colours"):
        uplift.build(scene=[], dim=4)


def test_unknown_encodings_and_gamut_mappings_are_refused(plain_cube):
    with raises(OptionError):
        points_of(plain_cube, PHOTO, encoding="log")
    with raises(OptionError, "unknown-gamut-mapping"):
        points_of(plain_cube, PHOTO, out_of_gamut="squash")


def test_realisable_colours_of_a_wide_gamut_have_exact_round_trips(tmp_path):
    rgb = np.random.default_rng(2).random((8, 8, 3)).astype(np.float32)
    path = write_exr(tmp_path / "wide.exr", planes(rgb))
    with warns("colour-space-assumed"):
        cube = uplift.build(scene=[path], dim=8, space="ITU-R BT.2020")
    data, colours = cube.data, rgb.reshape(-1, 3).astype(float)
    assert data.points.counts()["unfitted"] == 0
    assert data.points.counts()["unrealisable"] > 0
    corners, _ = data.lattice.corners(colours)
    possible = ~(data.points.status[corners] == Status.UNREALISABLE).any(axis=1)
    back = data.sensor.rgb(cube.reflectance(colours))
    assert possible.sum() > 10
    np.testing.assert_allclose(back[possible], colours[possible], rtol=0, atol=data.threshold)


def test_rebuild_needs_no_images(scene_cube):
    again = rebuild(scene_cube, "photo.uplift", [ATLASES])
    assert digest(again.data) == digest(scene_cube.data)
    assert compare_rebuilt("photo.uplift", scene_cube.data, again.data).failures == ()
    assert again.data.provenance["scene"][0]["name"] == PHOTO.name


def test_a_filled_cube_cannot_be_rebuilt(scene_cube):
    with raises(CubeFileError, "cube-file"):
        rebuild(scene_cube.fill_missing([1, 1, 0]), "photo.uplift", [ATLASES])
