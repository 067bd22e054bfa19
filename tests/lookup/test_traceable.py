"""Traced spectra and coefficients agree with numpy."""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import near_black, raises, warns, with_absent_points
from tests.lookup.test_bulk import CUBES, colours
from uplift.common.errors import ColourError, OptionError
from uplift.lattice.lattice import Lattice
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import is_inexact
from uplift.lookup.traceable import evaluate, traceable, traceable_coefficients

AT = np.linspace(380, 780, 9)


@pytest.fixture(params=CUBES)
def cube(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def traced(small_cube):
    return traceable(small_cube, AT)


@pytest.mark.parametrize(("kind", "most"), [(np.float32, 2e-5), (np.float64, 1e-9)])
def test_spectra_are_those_of_numpy(cube, kind, most):
    """Rounding moves a colour in a small entry box towards its face."""
    rgb = colours(cube.data).astype(kind)
    with jax.enable_x64(kind == np.float64):
        found = np.asarray(evaluate(traceable(cube, AT, dtype=kind), rgb))
    assert found.dtype == kind
    assert ((found >= 0) & (found <= 1)).all()
    expected = cube.reflectance(rgb, AT)
    assert_allclose(found, expected, rtol=0, atol=most)
    assert np.abs(found - expected).mean() < most / 200


@pytest.mark.parametrize(
    ("name", "kind", "most"),
    [("wide_cube", np.float32, 1e-3), ("wide_sigmoid_cube", np.float64, 1e-6)],
)
def test_spectra_next_to_unrealisable_colours_are_those_of_numpy(
    request, name, kind, most
):
    cube = request.getfixturevalue(name)
    rgb = np.random.default_rng(8).random((300, 3)).astype(kind)
    rgb[:100] **= 3
    with jax.enable_x64(kind == np.float64):
        traced = traceable(cube, AT, dtype=kind)
        found = np.asarray(evaluate(traced, rgb))
    assert ((found >= 0) & (found <= 1)).all()
    off = np.abs(found - cube.reflectance(rgb, AT)).max(axis=1)
    inside = cube.data.solid.signed_distance(rgb) < -1e-3
    assert (is_inexact(cube.data, rgb) & inside).sum() > 50
    assert off[inside].max() < most
    assert np.median(off) < most / 100


def test_colours_next_to_unrealisable_ones_may_be_mapped_one_by_one(wide_cube):
    rgb = np.random.default_rng(8).random((40, 3)).astype(np.float32)
    traced = traceable(wide_cube, AT)
    by_colour = jax.vmap(evaluate, (None, 0))(traced, rgb)
    inside = wide_cube.data.solid.signed_distance(rgb) < -1e-3
    expected = evaluate(traced, rgb)[inside]
    assert_allclose(by_colour[inside], expected, rtol=0, atol=1e-3)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_coefficients_are_those_of_numpy(cube, kind):
    rgb = colours(cube.data).astype(np.float32)
    for count in {cube.coefficient_count, cube.entry_coefficient_count}:
        expected = cube.coefficients(rgb, count)
        with jax.enable_x64(kind == np.float64):
            traced = traceable_coefficients(cube, count, dtype=kind)
            found = np.asarray(evaluate(traced, rgb))
        assert found.dtype == kind
        # numpy sums stored coefficients in their type, which may be float32.
        tolerance = 2e-5 if kind == np.float32 else 1e-6
        size = np.abs(expected).max()
        assert_allclose(found, expected, rtol=0, atol=tolerance * max(size, 1))


def test_images_and_single_colours_have_the_same_spectra(traced):
    rgb = np.random.default_rng(3).random((2, 5, 3)).astype(np.float32)
    image = evaluate(traced, rgb)
    assert image.shape == (2, 5, 9)
    assert evaluate(traced, np.zeros((0, 3))).shape == (0, 9)
    assert_allclose(evaluate(traced, rgb[1, 2].tolist()), image[1, 2], atol=1e-6)


def test_colours_outside_are_clamped_and_nan_gives_nan(traced):
    inside = evaluate(traced, [[1.0, 0.0, 0.5], [1.0, 1.0, 1.0]])
    outside = [[1.5, -0.2, 0.5], [np.inf, 2, 1e30], [0.5, np.nan, 0.5]]
    found = evaluate(traced, outside)
    assert_array_equal(found[:2], inside)
    assert np.isnan(found[2]).all()


@pytest.mark.parametrize(
    "rgb",
    [0.5, [0.5, 0.5], np.zeros((3, 4)), [], "red", None, [[0.1], [0.1, 0.2, 0.3]]],
)
def test_other_shapes_are_refused(traced, rgb):
    with raises(ColourError):
        evaluate(traced, rgb)
    with raises(ColourError):
        jax.jit(evaluate)(traced, jnp.zeros((3, 4)))


def test_single_precision_stays_where_doubles_are_enabled(traced, doubles):
    assert evaluate(traced, np.array([0.5, 0.25, 0.125])).dtype == np.float32


def test_colours_that_a_sparse_cube_lacks_have_nan(plain_cube):
    data = with_absent_points(plain_cube.data, near_black(plain_cube.data))
    rgb = np.array([[0.01, 0.001, 0.001], [0.9, 0.9, 0.9]])
    dark, light = evaluate(traceable(Cube(data), AT), rgb)
    assert_allclose(dark, plain_cube.reflectance(rgb[0], AT), atol=1e-5)
    assert np.isnan(light).all()


def test_traced_coefficients_of_wide_gamuts_warn(wide_cube):
    with warns("traced-colours-inexact"):
        traced = traceable_coefficients(wide_cube)
    stored = wide_cube.data.points.coefficients[0]
    assert_allclose(evaluate(traced, [0.0, 0.0, 0.0]), stored, atol=1e-6)


def test_invalid_options_are_refused(small_cube, plain_cube):
    nodes = plain_cube.data.lattice.nodes.copy()
    nodes[4] = nodes[3] + 1e-9
    close = Cube(replace(plain_cube.data, lattice=Lattice(nodes)))
    for use in (
        partial(traceable, small_cube, [0]),
        partial(traceable, small_cube, dtype=np.float16),
        partial(traceable, small_cube, dtype=np.float64),  # not enabled
        partial(traceable, close),  # for float32
        partial(traceable_coefficients, small_cube, dtype=np.float64),
        partial(traceable_coefficients, small_cube, 5),
        partial(traceable_coefficients, close),
    ):
        with raises(OptionError):
            use()
