"""Asking a cube: exact at the nodes, faithful between them, whole batches as single colours, bad input named."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from uplift.errors import ColourError, OptionError
from uplift.lookup import MODES
from uplift.lookup.interpolate import BLOCK

GRID = np.arange(380.0, 781.0, 5.0)
COLOURS = np.random.default_rng(11).random((300, 3))
each_mode = pytest.mark.parametrize("mode", MODES)


@each_mode
def test_a_node_answers_with_its_own_spectrum(small_cube, mode):
    data = small_cube.data
    own = data.model.squash(data.model.from_storage(data.coefficients) @ data.model.basis(GRID).T)
    moved = (
        1e-3 if mode == "refined" else 2e-5
    )  # refinement goes on where the fit was content with 1e-6 of RGB
    np.testing.assert_allclose(small_cube.reflectance(data.lattice.points, GRID, mode), own, atol=moved)


def test_coefficients_at_a_node_are_the_stored_ones(small_cube):
    data = small_cube.data
    np.testing.assert_array_equal(small_cube.coefficients(data.lattice.points), data.coefficients)


@pytest.mark.parametrize(("mode", "most"), [("spectra", 1e-6), ("refined", 1e-6), ("moments", 0.1)])
def test_the_round_trip_of_each_mode(small_cube, mode, most):
    back = small_cube.data.sensor.rgb(small_cube.reflectance(COLOURS, mode=mode))
    assert np.abs(back - COLOURS).max() <= most


def test_refinement_is_what_makes_the_difference(small_cube, small_sigmoid_cube):
    for cube in (small_cube, small_sigmoid_cube):
        off = {
            mode: np.abs(cube.data.sensor.rgb(cube.reflectance(COLOURS, mode=mode)) - COLOURS).max()
            for mode in ("moments", "refined")
        }
        assert off["refined"] < 1e-2 * off["moments"]


@each_mode
def test_answers_stay_within_0_and_1(small_cube, small_sigmoid_cube, mode):
    for cube in (small_cube, small_sigmoid_cube):
        corners = np.array(np.meshgrid(*[[0.0, 1e-6, 1 - 1e-6, 1.0]] * 3)).reshape(3, -1).T
        found = cube.reflectance(corners, mode=mode)
        assert np.isfinite(found).all()
        assert (found >= 0).all()
        assert (found <= 1 + 1e-12).all()


@each_mode
def test_shared_faces_of_cells_answer_the_same_from_both_sides(small_cube, mode):
    face = small_cube.data.lattice.nodes[4]
    at = np.array([[face, 0.3, 0.4], [0.2, face, 0.6], [0.9, 0.1, face]])
    below, above = (small_cube.reflectance(at + shift * (at == face), mode=mode) for shift in (-1e-12, 1e-12))
    np.testing.assert_allclose(below, above, atol=1e-7)


@each_mode
def test_a_batch_answers_as_its_colours_alone(small_cube, mode):
    many = np.resize(COLOURS, (BLOCK + 7, 3))
    batch = small_cube.reflectance(many, [450, 550, 650], mode)
    for row in (0, 5, BLOCK - 1, BLOCK, BLOCK + 6):
        alone = small_cube.reflectance(many[row], [450, 550, 650], mode)
        np.testing.assert_allclose(batch[row], alone, atol=1e-12)


@pytest.mark.parametrize("shape", [(3,), (0, 3), (1, 3), (2, 5, 3)])
def test_shapes_are_kept(small_cube, shape):
    rgb = np.full(shape, 0.4)
    assert small_cube.reflectance(rgb).shape == (*shape[:-1], 81)
    assert small_cube.reflectance(rgb, [500, 600]).shape == (*shape[:-1], 2)
    assert small_cube.reflectance(rgb, 500).shape == (*shape[:-1], 1)
    assert small_cube.coefficients(rgb).shape == (*shape[:-1], 9)


def test_lists_and_float32_are_welcome(small_cube):
    expected = small_cube.reflectance(np.array([0.25, 0.5, 0.75]))
    np.testing.assert_array_equal(small_cube.reflectance([0.25, 0.5, 0.75]), expected)
    np.testing.assert_array_equal(small_cube.reflectance(np.float32([0.25, 0.5, 0.75])), expected)


def test_outside_the_range_spectra_are_held_flat(small_cube):
    low, first, last, high = small_cube.reflectance([0.5, 0.2, 0.1], [300, 380, 780, 1000])
    assert (low, high) == (first, last)


def test_a_colour_is_not_refused_for_its_rounding(small_cube):
    np.testing.assert_array_equal(
        small_cube.reflectance([1 + 1e-12, -1e-12, 0.5]), small_cube.reflectance([1, 0, 0.5])
    )


@pytest.mark.parametrize(
    ("rgb", "message"),
    [
        ([1.01, 0, 0], r"linear RGB \(1.01, 0, 0\) lies outside \[0, 1\]"),
        ([[0, 0, 0], [0.5, -0.1, 0]], r"\(0.5, -0.1, 0\)"),
        ([np.nan, 0, 0], r"\(nan, 0, 0\)"),
        ([np.inf, 0, 0], r"\(inf, 0, 0\)"),
        ([0.1, 0.2], "three numbers"),
        (0.3, "three numbers"),
        ("red", "three numbers"),
        ([[0.1, 0.2, 0.3], [0.1, 0.2]], "three numbers"),
    ],
)
def test_bad_colours_are_named(small_cube, rgb, message):
    for ask in (small_cube.reflectance, small_cube.coefficients):
        with pytest.raises(ColourError, match=message):
            ask(rgb)


@pytest.mark.parametrize("wavelengths", [[], [0], [-5.0], [np.nan], [np.inf], [[500, 600]], "green"])
def test_bad_wavelengths_are_refused(small_cube, wavelengths):
    with pytest.raises((OptionError, ColourError), match="wavelengths"):
        small_cube.reflectance([0.1, 0.2, 0.3], wavelengths)


def test_an_unknown_mode_is_refused(small_cube):
    with pytest.raises(OptionError, match="unknown mode 'exact'; use one of spectra, moments, refined"):
        small_cube.reflectance([0.1, 0.2, 0.3], mode="exact")


def test_codes_are_decoded_as_srgb(small_cube):
    import colour

    codes = np.arange(256)
    np.testing.assert_allclose(small_cube.decode(codes), colour.models.eotf_sRGB(codes / 255), atol=1e-12)
    np.testing.assert_allclose(small_cube.encode(small_cube.decode(codes)), codes, atol=1e-9)
    for bad in (-1, 256, np.nan):
        with pytest.raises(ColourError, match="0 to 255"):
            small_cube.decode(bad)


def test_the_package_carries_a_cube_of_its_own():
    data = uplift.load().data
    assert (data.sensor.space, data.sensor.illuminant) == ("sRGB", "D65")
    assert data.atlas.names == ()
    assert data.counts()["unfitted"] == 0


def test_a_saved_cube_answers_as_before(small_cube, tmp_path):
    small_cube.save(tmp_path / "cube.uplift")
    again = uplift.load(tmp_path / "cube.uplift")
    np.testing.assert_array_equal(again.reflectance(COLOURS), small_cube.reflectance(COLOURS))
