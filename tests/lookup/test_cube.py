"""Queries of a cube: shapes, types of input, errors, 8-bit codes, files by name."""

from __future__ import annotations

import os

import colour
import numpy as np
import pytest

import uplift
from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.lattice import Status
from uplift.lookup import MODES
from uplift.lookup.cube import DEFAULT, PACKAGED, find_file

RED = (0.6, 0.03, 0.01)


def random_colours(count, seed=0):
    return np.random.default_rng(seed).random((count, 3))


@pytest.fixture(params=MODES)
def mode(request):
    return request.param


@pytest.mark.parametrize("shape", [(), (1,), (5,), (2, 3), (2, 0), (0,), (4, 1, 2)])
def test_reflectance_keeps_the_shape_of_the_input(small_cube, mode, shape):
    rgb = np.random.default_rng(0).random((*shape, 3))
    assert small_cube.reflectance(rgb, mode=mode).shape == (*shape, 81)
    assert small_cube.reflectance(rgb, [500, 600], mode).shape == (*shape, 2)
    assert small_cube.coefficients(rgb).shape == (*shape, 9)


@pytest.mark.parametrize("kind", [list, tuple, np.float32, np.float16, np.longdouble])
def test_other_numeric_types_are_accepted(small_cube, kind):
    exact = np.array([0.5, 0.25, 0.125])
    rgb = kind(exact) if kind in (list, tuple) else exact.astype(kind)
    np.testing.assert_array_equal(small_cube.reflectance(rgb), small_cube.reflectance(exact))
    assert small_cube.reflectance(rgb).dtype == np.float64


def test_the_input_is_not_modified(small_cube, mode):
    rgb = random_colours(3)
    rgb[0] = 1 + 1e-12
    before = rgb.copy()
    small_cube.reflectance(rgb, mode=mode)
    np.testing.assert_array_equal(rgb, before)


def test_wavelengths_may_be_unordered_and_repeated(small_cube, mode):
    both = small_cube.reflectance(RED, [700, 400, 555.5, 400], mode)
    for column, wavelength in enumerate((700, 400, 555.5, 400)):
        single = small_cube.reflectance(RED, wavelength, mode)
        assert single.shape == (1,)
        np.testing.assert_allclose(single[0], both[column], rtol=0, atol=1e-12)
    assert small_cube.reflectance(RED, range(380, 781, 5), mode).shape == (81,)


def test_spectra_are_constant_outside_their_range(small_cube, small_sigmoid_cube, mode):
    rgb = random_colours(20)
    for cube in (small_cube, small_sigmoid_cube):
        for outside, end in [((1.0, 300.0, 379.9), 380.0), ((780.1, 1000.0, 1e9), 780.0)]:
            values = cube.reflectance(rgb, outside, mode)
            expected = np.broadcast_to(cube.reflectance(rgb, [end], mode), values.shape)
            np.testing.assert_allclose(values, expected, rtol=0, atol=1e-14)


def test_reflectances_lie_between_0_and_1(small_cube, small_sigmoid_cube, mode):
    corners = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
    for cube in (small_cube, small_sigmoid_cube):
        values = cube.reflectance(np.concatenate([corners, random_colours(500)]), mode=mode)
        assert values.min() >= 0
        assert values.max() <= 1


@pytest.mark.parametrize(
    "rgb",
    [
        (np.nan, 0, 0),
        (-0.001, 0, 0),
        (0, 1.001, 0),
        0.5,
        (0.5, 0.5),
        (0.5, 0.5, 0.5, 0.5),
        [],
        [[0.5, 0.5, 0.5], [0.5, 0.5]],
        "red",
        None,
        np.zeros((3, 2)),
    ],
)
def test_invalid_colours_are_refused(small_cube, mode, rgb):
    with pytest.raises(ColourError) as caught:
        small_cube.reflectance(rgb, mode=mode)
    assert "\n" not in str(caught.value)
    with pytest.raises(ColourError):
        small_cube.coefficients(rgb)


def test_the_error_quotes_the_invalid_colour(small_cube):
    rgb = random_colours(10)
    rgb[7] = (0.5, 1.25, 0)
    with raises(ColourError, "rgb-out-of-gamut") as caught:
        small_cube.reflectance(rgb)
    assert "(0.5, 1.25, 0)" in caught.value.problem


def test_rounding_moves_no_colour_out_of_gamut(small_cube, mode):
    for bit in (1e-12, -1e-12):
        for base in ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.5, 0.0)):
            near = small_cube.reflectance(np.array(base) + bit, mode=mode)
            assert near.min() >= 0
            assert near.max() <= 1
            np.testing.assert_allclose(near, small_cube.reflectance(base, mode=mode), rtol=0, atol=1e-8)
    with pytest.raises(ColourError):
        small_cube.reflectance([1 + 1e-8, 0, 0], mode=mode)


@pytest.mark.parametrize("name", ["", "Spectra", "exact", None, 3])
def test_unknown_modes_are_refused(small_cube, name):
    with raises(OptionError, "unknown-mode"):
        small_cube.reflectance(RED, mode=name)


@pytest.mark.parametrize(
    "wavelengths",
    [[], [0], [-500], [500, np.nan], [np.inf], "red", ["a"], [[400, 500], [600, 700]], [[400], [500, 600]], {}],
)
def test_invalid_wavelengths_are_refused(small_cube, mode, wavelengths):
    with raises(OptionError, "invalid-wavelengths"):
        small_cube.reflectance(RED, wavelengths, mode)


def test_codes_decode_as_srgb(small_cube):
    codes = np.arange(256)
    expected = colour.cctf_decoding(codes / 255, "sRGB")
    np.testing.assert_allclose(small_cube.decode(codes), expected, rtol=0, atol=1e-15)


def test_decoding_and_encoding_are_inverse(small_cube):
    codes = np.linspace(0, 255, 1021).reshape(1021, 1)
    np.testing.assert_allclose(small_cube.encode(small_cube.decode(codes)), codes, rtol=0, atol=1e-10)
    rgb = random_colours(100)
    np.testing.assert_allclose(small_cube.decode(small_cube.encode(rgb)), rgb, rtol=0, atol=1e-14)


@pytest.mark.parametrize("codes", [-1, 256, [0, 255.001, 3], np.nan, np.inf, "red", [[1], [2, 3]]])
def test_codes_out_of_range_are_refused(small_cube, codes):
    with raises(ColourError, "invalid-codes"):
        small_cube.decode(codes)


def test_a_saved_cube_gives_equal_answers(small_cube, tmp_path, mode):
    small_cube.save(tmp_path / "cube.uplift")
    again = uplift.load(tmp_path / "cube.uplift")
    rgb = random_colours(50)
    np.testing.assert_array_equal(again.reflectance(rgb, mode=mode), small_cube.reflectance(rgb, mode=mode))


def test_the_default_cube_is_srgb_without_an_atlas_and_fully_fitted():
    data = uplift.load().data
    assert (data.sensor.space, data.sensor.illuminant) == ("sRGB", "D65")
    assert data.atlas.names == ()
    assert not set(data.points.status.tolist()) & {Status.UNFITTED, Status.UNREALISABLE}
    assert data.points.distance.max() <= data.threshold
    assert (data.points.entry == -1).all()


@pytest.mark.parametrize("name", PACKAGED)
def test_names_stand_for_files_in_any_case(name):
    assert find_file(name) == find_file(name.upper()) == PACKAGED[name]
    assert os.path.isfile(PACKAGED[name])


@pytest.mark.parametrize("name", ["missing", "srgb.uplift", b"other"])
def test_other_paths_stay_what_they_are(name):
    assert find_file(name) is name


def test_files_take_precedence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "srgb").write_bytes(PACKAGED["acescg"].read_bytes())
    assert find_file("srgb") == "srgb"
    assert find_file("sRGB") == DEFAULT
