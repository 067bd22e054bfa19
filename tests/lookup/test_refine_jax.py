"""Traced spectra next to unrealisable colours are those of numpy, with their
derivatives.
"""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import near_black, warns, with_absent_points
from uplift.lookup import Cube
from uplift.lookup.interpolate import is_inexact
from uplift.lookup.traceable import evaluate, traceable, traceable_coefficients

AT = np.linspace(370, 790, 6)
STEP = 1e-6
SPACE = "ITU-R BT.2020"


def with_entry():
    """A cube with an entry box in an inexact cell."""
    entry = uplift.Entry("paint", np.array([380.0, 780.0]), np.array([0.2, 0.5]))
    return uplift.build(uplift.Atlas((entry,)), dim=3, space=SPACE)


CUBES = {
    "packaged": lambda: uplift.load("acescg"),
    "entry": with_entry,
    "sigmoid": lambda: uplift.build(dim=3, space=SPACE, model="sigmoid"),
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


def colours(cube, count=700):
    """Colours anywhere, saturated and dark ones, greys, and those around entries."""
    rng = np.random.default_rng(8)
    near = cube.data.atlas.rgb + rng.uniform(
        -0.1, 0.1, (60, len(cube.data.atlas.rgb), 3)
    )
    greys = np.linspace(0, 1, 9)[:, None].repeat(3, axis=1)
    some = rng.random((count, 3))
    rgb = np.concatenate([some, some[::2] ** 3, greys, np.eye(3), *near])
    return np.clip(rgb, 0, 1)


def inexact_colours(cube):
    """Colours in inexact cells, more than a step from the faces of the space."""
    rgb = np.clip(colours(cube, 200), 2 * STEP, 1 - 2 * STEP)
    return rgb[is_inexact(cube.data, rgb)]


def realisable(cube, rgb, depth=0.0):
    return cube.data.solid.signed_distance(rgb) < -depth


def test_spectra_in_float64_are_those_of_numpy(cube, doubles):
    rgb = colours(cube)
    for at in (None, AT):
        found = evaluate(traceable(cube, at, dtype=np.float64), rgb)
        off = np.abs(found - cube.reflectance(rgb, at)).max(axis=1)
        assert off[realisable(cube, rgb)].max() < 1e-6
        assert np.quantile(off, 0.99) < 1e-6


def test_spectra_in_float32_are_those_of_numpy(cube):
    rgb = colours(cube).astype(np.float32)
    found = np.asarray(evaluate(traceable(cube), rgb))
    assert found.dtype == np.float32
    assert found.min() >= 0
    assert found.max() <= 1
    off = np.abs(found - cube.reflectance(rgb)).max(axis=1)
    assert off[realisable(cube, rgb, depth=1e-3)].max() < 1e-3
    assert np.median(off) < 1e-5


def test_realisable_colours_are_exact(cube, doubles):
    rgb = colours(cube)
    rgb = rgb[realisable(cube, rgb)]
    found = evaluate(traceable(cube, dtype=np.float64), rgb)
    assert_allclose(cube.data.sensor.rgb(np.asarray(found)), rgb, rtol=0, atol=1e-4)


def test_derivatives_are_finite_differences(cube, doubles):
    rgb = inexact_colours(cube)
    assert len(rgb) > 60
    assert not realisable(cube, rgb).all()
    traced = traceable(cube, AT, dtype=np.float64)
    jacobian = jax.vmap(jax.jacrev(partial(evaluate, traced)))(rgb)
    assert np.isfinite(jacobian).all()
    for axis, step in enumerate(STEP * np.eye(3)):
        rise = cube.reflectance(rgb + step, AT) - cube.reflectance(rgb - step, AT)
        difference = rise / (2 * STEP)
        scale = np.maximum(np.abs(difference), 1)
        # Facets of the solid, and faces of cells, may lie within a step of a few.
        off = np.abs(jacobian[:, :, axis] - difference) / scale
        assert np.quantile(off, 0.98) < 1e-4
    forward = jax.vmap(jax.jacfwd(partial(evaluate, traced)))(rgb)
    assert_allclose(forward, jacobian, rtol=1e-6, atol=1e-6)
    # Of a whole array, whose colours are sorted and moved by chunks, they are the same.
    _, pull_back = jax.vjp(partial(evaluate, traced), rgb)
    (gradient,) = pull_back(jnp.ones((len(rgb), len(AT))))
    assert_allclose(gradient, jacobian.sum(axis=1), rtol=1e-6, atol=1e-6)


def test_colours_of_realisable_spectra_follow_the_requested_ones(packaged, doubles):
    """The colour of the answer is the request: its derivative is the identity."""
    rgb = inexact_colours(packaged)
    rgb = rgb[realisable(packaged, rgb, depth=1e-3)]
    traced = traceable(packaged, dtype=np.float64)
    matrix = packaged.data.sensor.matrix
    jacobian = jax.vmap(jax.jacrev(lambda x: matrix @ evaluate(traced, x)))(rgb)
    assert_allclose(
        jacobian,
        np.eye(3).repeat(len(rgb), 0).reshape(3, -1, 3).swapaxes(0, 1),
        atol=1e-6,
    )


def test_second_derivatives_are_differences_of_the_first(packaged, doubles):
    rgb = inexact_colours(packaged)[:30]
    traced = traceable(packaged, AT, dtype=np.float64)
    total = lambda x: evaluate(traced, x).sum()  # noqa: E731
    found = jax.vmap(jax.hessian(total))(rgb)
    gradient = jax.vmap(jax.grad(total))
    for axis, step in enumerate(STEP * np.eye(3)):
        difference = (gradient(rgb + step) - gradient(rgb - step)) / (2 * STEP)
        off = np.abs(found[:, :, axis] - difference)
        assert np.median(off / np.maximum(np.abs(difference), 1)) < 1e-4


def test_derivatives_by_nodes_are_finite_differences(packaged, doubles):
    traced = traceable(packaged, AT, dtype=np.float64)
    rgb = inexact_colours(packaged)[:20]
    direction = np.random.default_rng(3).normal(size=traced.grid.lattice.shape)

    def moved(step):
        grid = traced.grid
        grid = grid._replace(lattice=grid.lattice + step * direction)
        return evaluate(type(traced)(traced.wavelengths, grid, traced.moves), rgb)

    _, found = jax.jvp(moved, (0.0,), (1.0,))
    step = 1e-8
    difference = (moved(step) - moved(-step)) / (2 * step)
    off = np.abs(found - difference) / np.maximum(np.abs(difference), 1)
    assert np.quantile(off, 0.9) < 1e-3


def test_derivatives_in_float32_are_finite_and_mostly_those_in_float64(packaged):
    rgb = np.float32(inexact_colours(packaged))
    jacobians = []
    for kind in (np.float32, np.float64):
        with jax.enable_x64(kind == np.float64):
            traced = traceable(packaged, AT, dtype=kind)
            of_rgb = jax.vmap(jax.jacfwd(partial(evaluate, traced)))
            jacobians.append(np.asarray(of_rgb(jnp.asarray(rgb, kind))))
    single, double = jacobians
    assert np.isfinite(single).all()
    off = np.abs(single - double) / np.maximum(np.abs(double), 1)
    assert np.quantile(off[realisable(packaged, rgb)], 0.99) < 0.01


def test_single_colours_and_arrays_have_the_same_spectra(packaged):
    rgb = np.random.default_rng(2).random((600, 3)).astype(np.float32)  # two chunks
    traced = traceable(packaged, AT)
    spectra = evaluate(traced, rgb)
    assert_allclose(jax.vmap(partial(evaluate, traced))(rgb), spectra, atol=1e-3)
    assert_allclose(evaluate(traced, rgb[7]), spectra[7], atol=1e-3)
    assert evaluate(traced, np.zeros((0, 3))).shape == (0, 6)


def test_nan_harms_no_other_colours(packaged, doubles):
    traced = traceable(packaged, AT, dtype=np.float64)
    rgb = inexact_colours(packaged)[:5]
    batch = np.concatenate([[[np.nan, 0, 0]], rgb])
    total = lambda x: jnp.nansum(evaluate(traced, x))  # noqa: E731
    assert np.isnan(evaluate(traced, batch)[0]).all()
    assert_allclose(jax.grad(total)(batch)[1:], jax.grad(total)(rgb), rtol=1e-9)


def test_colours_that_a_sparse_cube_lacks_have_nan(packaged):
    sparse = Cube(with_absent_points(packaged.data, near_black(packaged.data)))
    dark, light = evaluate(traceable(sparse, AT), [[0.01, 0.001, 0.001], [0.9] * 3])
    assert_allclose(dark, packaged.reflectance([0.01, 0.001, 0.001], AT), atol=1e-4)
    assert np.isnan(light).all()


def test_coefficients_warn_and_are_weighted(packaged):
    with warns("traced-colours-inexact"):
        traced = traceable_coefficients(packaged)
    nodes = packaged.data.lattice.points[:9]
    stored = packaged.data.points.coefficients[:9]
    assert_array_equal(evaluate(traced, np.float32(nodes))[0], stored[0])
