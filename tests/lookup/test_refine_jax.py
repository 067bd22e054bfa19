"""Traced spectra next to unrealisable colours are those of numpy, with their
derivatives.

Compiling takes most of the time: all tests of a cube use as many colours.
"""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import near_black, warns, with_absent_points
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import is_inexact
from uplift.lookup.traceable import evaluate, traceable, traceable_coefficients

AT = np.linspace(370, 790, 6)
STEP = 1e-6
SPACE = "ITU-R BT.2020"
COUNT = 600
"""Colours: more than one chunk."""


def with_entry():
    """A cube with an entry box in an inexact cell."""
    entry = uplift.Entry("paint", np.array([380.0, 780.0]), np.array([0.2, 0.5]))
    return uplift.build(uplift.Atlas((entry,)), dim=3, space=SPACE)


CUBES = {
    "packaged": partial(uplift.load, "acescg"),
    "entry": with_entry,
    "sigmoid": partial(uplift.build, dim=3, space=SPACE, model="sigmoid"),
}


@pytest.fixture(scope="module", params=CUBES)
def cube(request):
    return CUBES[request.param]()


@pytest.fixture(scope="module")
def packaged():
    return uplift.load("acescg")


@pytest.fixture
def doubles():
    with jax.enable_x64(True):
        yield


def colours(cube):
    """Colours anywhere, dark ones, greys, and those around an entry; a step inside."""
    rng = np.random.default_rng(8)
    rgb = rng.random((COUNT, 3))
    rgb[:200] **= 3
    rgb[200:209] = np.linspace(0.1, 0.9, 9)[:, None]
    for entry in cube.data.atlas.rgb:
        rgb[300:360] = entry + rng.uniform(-0.1, 0.1, (60, 3))
    return np.clip(rgb, 2 * STEP, 1 - 2 * STEP)


def realisable(cube, rgb, depth=0.0):
    return cube.data.solid.signed_distance(rgb) < -depth


def derivative(traced, rgb, of_rgb, of_lattice=0.0):
    """Derivative of spectra in a direction of colours and of values of nodes."""

    def function(rgb, lattice):
        grid = traced.grid._replace(lattice=lattice)
        return evaluate(replace(traced, grid=grid), rgb)

    lattice = traced.grid.lattice
    start = (jnp.asarray(rgb, lattice.dtype), lattice)
    directions = (of_rgb, of_lattice)
    change = [
        jnp.broadcast_to(direction, at.shape).astype(at.dtype)
        for direction, at in zip(directions, start, strict=True)
    ]
    return np.asarray(jax.jvp(function, start, tuple(change))[1])


def test_spectra_in_float64_are_those_of_numpy(cube, doubles):
    rgb = colours(cube)
    found = np.asarray(evaluate(traceable(cube, dtype=np.float64), rgb))
    off = np.abs(found - cube.reflectance(rgb)).max(axis=1)
    inside = realisable(cube, rgb)
    assert (is_inexact(cube.data, rgb) & inside).sum() > 50
    assert not inside.all()
    assert off[inside].max() < 1e-6
    assert np.quantile(off, 0.99) < 1e-6
    missed = np.abs(cube.data.sensor.rgb(found) - rgb).max(axis=1)
    assert missed[inside].max() < 1e-4


def test_spectra_in_float32_are_those_of_numpy(packaged):
    rgb = colours(packaged).astype(np.float32)
    found = np.asarray(evaluate(traceable(packaged, AT), rgb))
    assert found.dtype == np.float32
    assert found.min() >= 0
    assert found.max() <= 1
    off = np.abs(found - packaged.reflectance(rgb, AT)).max(axis=1)
    assert off[realisable(packaged, rgb, depth=1e-3)].max() < 1e-3
    assert np.median(off) < 1e-5


def test_derivatives_are_finite_differences(cube, doubles):
    rgb = colours(cube)
    traced = traceable(cube, dtype=np.float64)
    rows = is_inexact(cube.data, rgb)
    deep = rows & realisable(cube, rgb, depth=1e-3)
    for axis in np.eye(3):
        found = derivative(traced, rgb, axis)
        assert np.isfinite(found).all()
        step = STEP * axis
        rise = cube.reflectance(rgb[rows] + step) - cube.reflectance(rgb[rows] - step)
        difference = rise / (2 * STEP)
        scale = np.maximum(np.abs(difference), 1)
        # Facets of the solid, and faces of cells, may lie within a step of a few.
        assert np.quantile(np.abs(found[rows] - difference) / scale, 0.98) < 1e-4
        # The colour of the answer is the requested one: both rise alike.
        of_answer = cube.data.sensor.rgb(found[deep])
        assert_allclose(of_answer, axis[None].repeat(deep.sum(), 0), atol=1e-6)


def test_derivatives_by_nodes_are_finite_differences(packaged, doubles):
    traced = traceable(packaged, dtype=np.float64)
    rgb = colours(packaged)
    direction = np.random.default_rng(3).normal(size=traced.grid.lattice.shape)
    found = derivative(traced, rgb, 0.0, direction)
    step = 1e-8
    sides = []
    for side in (step, -step):
        grid = traced.grid
        grid = grid._replace(lattice=grid.lattice + side * direction)
        sides.append(evaluate(replace(traced, grid=grid), rgb))
    difference = np.asarray(sides[0] - sides[1]) / (2 * step)
    off = np.abs(found - difference) / np.maximum(np.abs(difference), 1)
    assert np.quantile(off[realisable(packaged, rgb, depth=1e-3)], 0.98) < 1e-3


def test_gradients_are_forward_derivatives_and_nan_harms_none(packaged, doubles):
    traced = traceable(packaged, dtype=np.float64)
    rgb = colours(packaged)
    weights = np.random.default_rng(4).random((COUNT, len(packaged.wavelengths)))
    gradient = jax.jit(jax.grad(lambda x: jnp.nansum(weights * evaluate(traced, x))))
    found = gradient(rgb)
    for number, axis in enumerate(np.eye(3)):
        forward = (weights * derivative(traced, rgb, axis)).sum(axis=1)
        assert_allclose(found[:, number], forward, rtol=1e-6, atol=1e-6)
    rgb[0] = np.nan
    assert np.isnan(evaluate(traced, rgb)[0]).all()
    assert_allclose(gradient(rgb)[1:], found[1:], rtol=1e-6, atol=1e-6)


def test_derivatives_in_float32_are_mostly_those_in_float64(packaged):
    rgb = np.float32(colours(packaged))
    derivatives = []
    for kind in (np.float32, np.float64):
        with jax.enable_x64(kind == np.float64):
            traced = traceable(packaged, dtype=kind)
            derivatives.append(derivative(traced, rgb, np.array([1, 0.5, -1])))
    single, double = derivatives
    assert np.isfinite(single).all()
    off = np.abs(single - double) / np.maximum(np.abs(double), 1)
    assert np.quantile(off[realisable(packaged, rgb)], 0.99) < 0.01


def test_single_colours_and_arrays_have_the_same_spectra(packaged):
    rgb = colours(packaged).astype(np.float32)
    traced = traceable(packaged, AT)
    spectra = evaluate(traced, rgb)
    by_colour = jax.vmap(partial(evaluate, traced))(rgb)
    inside = realisable(packaged, rgb, depth=1e-3)
    assert_allclose(by_colour[inside], spectra[inside], atol=1e-4)
    assert evaluate(traced, np.zeros((0, 3))).shape == (0, 6)


def test_colours_that_a_sparse_cube_lacks_have_nan(packaged, doubles):
    sparse = Cube(with_absent_points(packaged.data, near_black(packaged.data)))
    rgb = colours(packaged)
    rgb[:2] = [[0.01, 0.001, 0.001], [0.9, 0.9, 0.9]]
    dark, light = evaluate(traceable(sparse, dtype=np.float64), rgb)[:2]
    assert_allclose(dark, packaged.reflectance(rgb[0]), atol=1e-6)
    assert np.isnan(light).all()


def test_traced_coefficients_of_wide_gamuts_warn(packaged):
    with warns("traced-colours-inexact"):
        traced = traceable_coefficients(packaged)
    nodes = packaged.data.lattice.points[:9].astype(np.float32)
    stored = packaged.data.points.coefficients[:9]
    assert_array_equal(evaluate(traced, nodes)[0], stored[0])
