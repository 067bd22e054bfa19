"""Missing nodes filled from another cube: exact colours in every model."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import near_black, raises, with_absent_points
from uplift.common.errors import ColourError, OptionError
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES

RGB = np.random.default_rng(8).random((400, 3))


@pytest.fixture(params=["small_cube", "plain_cube", "small_sigmoid_cube"])
def whole(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def sparse(whole):
    return Cube(with_absent_points(whole.data, near_black(whole.data)))


def test_filling_keeps_present_points_and_has_exact_colours(whole, sparse):
    full = sparse.fill_missing()
    data = full.data
    there = sparse.data.points.present
    assert data.points.present.all()
    assert data.points.distance.max() <= data.threshold
    assert_allclose(full.data.sensor.rgb(full.reflectance(RGB)), RGB, rtol=0, atol=1e-4)
    assert_array_equal(
        data.points.coefficients[there], whole.data.points.coefficients[there]
    )
    assert_array_equal(data.points.status[there], whole.data.points.status[there])


def test_filled_spectra_are_those_of_the_default_cube(plain_cube):
    """At nodes of the same model, up to single precision."""
    data = plain_cube.data
    full = Cube(with_absent_points(data, near_black(data))).fill_missing()
    points = data.lattice.points[~near_black(data)]
    expected = uplift.load().reflectance(points, mode="refined")
    assert_allclose(full.reflectance(points), expected, atol=1e-5)


def test_only_the_points_that_the_colours_need_are_filled(sparse):
    queried = RGB[~sparse.covers(RGB)][:1]
    some = sparse.fill_missing(queried)
    assert some.covers(queried).all()
    assert 0 < some.data.points.present.sum() - sparse.data.points.present.sum() <= 8
    for mode in MODES:
        assert_allclose(
            some.reflectance(queried, mode=mode),
            sparse.fill_missing().reflectance(queried, mode=mode),
            atol=1e-6,
        )


def test_the_other_cube_may_be_chosen_and_has_the_space_and_the_colour(
    plain_cube, small_cube
):
    sparse = Cube(with_absent_points(plain_cube.data, near_black(plain_cube.data)))
    assert sparse.fill_missing([1, 1, 1], small_cube).covers([1, 1, 1])
    with raises(ColourError, "colour-not-in-scene"):
        sparse.fill_missing([1, 1, 1], sparse)
    with raises(OptionError, "cubes-of-different-spaces"):
        sparse.fill_missing([1, 1, 1], uplift.load("acescg"))
