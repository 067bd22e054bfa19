"""Traced spectra agree with numpy, and their derivatives with finite differences."""

from dataclasses import replace
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from tests.lookup.test_bulk import CUBES, colours
from uplift.common.errors import ColourError, OptionError
from uplift.lattice.lattice import Lattice
from uplift.lookup.cube import Cube
from uplift.lookup.traceable import evaluate, traceable, traceable_coefficients

AT = np.linspace(380, 780, 9)
STEP = 1e-6


@pytest.fixture(params=CUBES)
def cube(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def traced(small_cube):
    return traceable(small_cube, AT)


@pytest.fixture
def doubles():
    with jax.enable_x64(True):
        yield


def test_spectra_in_float32_are_those_of_numpy(cube):
    rgb = colours(cube.data).astype(np.float32)
    found = evaluate(traceable(cube, AT), rgb)
    assert found.dtype == np.float32
    assert found.min() >= 0
    assert found.max() <= 1
    expected = cube.reflectance(rgb, AT)
    # Rounding moves a colour in a small entry box towards its face.
    assert_allclose(found, expected, rtol=0, atol=2e-5)
    assert np.abs(found - expected).mean() < 1e-7


def test_spectra_in_float64_are_those_of_numpy(cube, doubles):
    rgb = colours(cube.data)
    found = evaluate(traceable(cube, AT, dtype=np.float64), rgb)
    assert found.dtype == np.float64
    assert_allclose(found, cube.reflectance(rgb, AT), rtol=0, atol=1e-9)


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
        assert repr(traced) == "TraceableCube(coefficients)"


def test_images_single_colours_and_batches_have_the_same_spectra(traced):
    rgb = np.random.default_rng(3).random((2, 5, 3)).astype(np.float32)
    image = evaluate(traced, rgb)
    assert image.shape == (2, 5, 9)
    assert evaluate(traced, np.zeros((0, 3))).shape == (0, 9)
    assert_allclose(jax.jit(evaluate)(traced, rgb), image, atol=1e-6)
    by_colour = jax.vmap(evaluate, (None, 0))(traced, rgb.reshape(-1, 3))
    assert_allclose(by_colour.reshape(image.shape), image, atol=1e-6)
    assert_allclose(evaluate(traced, rgb[1, 2].tolist()), image[1, 2], atol=1e-6)


def test_cubes_of_one_shape_share_compiled_code_and_can_be_batched(traced):
    darker = jax.tree.map(lambda array: array, traced)
    darker = replace(darker, grid=traced.grid._replace(lattice=traced.grid.lattice / 2))
    both = jax.tree.map(lambda *arrays: jnp.stack(arrays), traced, darker)
    rgb = np.array([0.5, 0.25, 0.125])
    spectra = jax.vmap(evaluate, (0, None))(both, rgb)
    assert_allclose(spectra[0], evaluate(traced, rgb), atol=1e-6)
    assert_allclose(spectra[1], evaluate(darker, rgb), atol=1e-6)


def away_from_faces(cube, rgb):
    """Colours that a step leaves in their cell and, if they are in one, entry box."""
    boxes = cube.data.entry_boxes
    steps = np.concatenate([np.eye(3), -np.eye(3)]) * 4 * STEP
    moved = np.clip(rgb[:, None] + steps, 0, 1)
    cells = [boxes.cell(rows) for rows in moved.transpose(1, 0, 2)]
    same = (np.array(cells) == boxes.cell(rgb)).all(axis=0)
    low, high = boxes.faces
    away = np.ones(len(rgb), dtype=bool)
    for face in (low, high):
        away &= (np.abs(rgb[:, None] - face) > 4 * STEP).all(axis=(1, 2))
    return rgb[same & away & (rgb > STEP).all(axis=1) & (rgb < 1 - STEP).all(axis=1)]


def random_colours(cube):
    """Colours anywhere, and in entry boxes."""
    rng = np.random.default_rng(11)
    low, high = cube.data.entry_boxes.faces
    inside = [low + rng.random(low.shape) * (high - low) for _ in range(4)]
    return away_from_faces(cube, np.concatenate([rng.random((200, 3)), *inside]))


def test_derivatives_by_colours_are_finite_differences(cube, doubles):
    traced = traceable(cube, AT, dtype=np.float64)
    rgb = random_colours(cube)
    assert len(rgb) > 150
    jacobian = jax.vmap(jax.jacrev(lambda colour: evaluate(traced, colour)))(rgb)
    for axis, step in enumerate(STEP * np.eye(3)):
        rise = cube.reflectance(rgb + step, AT) - cube.reflectance(rgb - step, AT)
        difference = rise / (2 * STEP)
        scale = np.maximum(np.abs(difference), 1)
        # The nearest face of a cone in a box may lie within a step of a few colours.
        off = np.abs(jacobian[:, :, axis] - difference) / scale
        assert np.quantile(off, 0.99) < 1e-4
    forward = jax.vmap(jax.jacfwd(lambda colour: evaluate(traced, colour)))(rgb)
    assert_allclose(forward, jacobian, rtol=1e-6, atol=1e-9)


def test_derivatives_in_float32_are_those_in_float64(small_cube, traced):
    rgb = random_colours(small_cube)
    single = jax.vmap(jax.jacfwd(lambda colour: evaluate(traced, colour)))(
        jnp.float32(rgb)
    )
    with jax.enable_x64(True):
        wide = traceable(small_cube, AT, dtype=np.float64)
        double = jax.vmap(jax.jacfwd(lambda colour: evaluate(wide, colour)))(rgb)
    expected = np.asarray(double)
    off = np.abs(np.asarray(single) - expected) / np.maximum(np.abs(expected), 1)
    assert np.quantile(off, 0.99) < 1e-3


def test_spectra_are_linear_in_the_spectra_of_nodes_and_entries(small_cube, doubles):
    """Σ of derivative times array is the spectrum: finite differences for free."""
    traced = traceable(small_cube, AT, dtype=np.float64)
    rgb = random_colours(small_cube)[:40]
    weights = np.random.default_rng(2).random((len(rgb), len(AT)))

    def total(lattice, atlas):
        grid = traced.grid._replace(lattice=lattice, atlas=atlas)
        return (weights * evaluate(replace(traced, grid=grid), rgb)).sum()

    grid = traced.grid
    of_nodes, of_entries = jax.grad(total, (0, 1))(grid.lattice, grid.atlas)
    assert (np.abs(of_entries).max(axis=1) > 0).any()
    again = (of_nodes * grid.lattice).sum() + (of_entries * grid.atlas).sum()
    assert_allclose(again, total(grid.lattice, grid.atlas), rtol=1e-9)
    # The whole pytree, whose integers have no gradient.
    loss = lambda cube: (weights * evaluate(cube, rgb)).sum()  # noqa: E731
    of_all = jax.grad(loss, allow_int=True)(traced)
    assert_allclose(of_all.grid.lattice, of_nodes, atol=1e-12)


def test_colours_outside_are_clamped_and_nan_gives_nan(traced):
    inside = evaluate(traced, [[1.0, 0.0, 0.5], [1.0, 1.0, 1.0]])
    outside = [[1.5, -0.2, 0.5], [np.inf, 2, 1e30]]
    assert_array_equal(evaluate(traced, outside), inside)
    mixed = evaluate(traced, [[0.5, np.nan, 0.5], [0.5, 0.5, 0.5]])
    assert np.isnan(mixed[0]).all()
    assert np.isfinite(mixed[1]).all()


def test_gradients_outside_are_zero_and_at_the_ends_those_of_the_inside(traced):
    gradient = jax.grad(lambda rgb: evaluate(traced, rgb).sum())
    assert_array_equal(gradient(jnp.array([1.5, -0.2, 0.5]))[:2], 0)
    for end, near in ((0.0, 1e-5), (1.0, 1 - 1e-5)):
        at_end = gradient(jnp.array([end, 0.3, 0.6]))
        inside = gradient(jnp.array([near, 0.3, 0.6]))
        assert_allclose(at_end, inside, rtol=0.01)
    # Gradients of other colours of a batch are unharmed by NaN.
    batch = jax.grad(lambda rgb: jnp.nansum(evaluate(traced, rgb)))
    rows = batch(jnp.array([[np.nan, 0, 0], [0.3, 0.4, 0.5]]))
    assert_allclose(rows[1], gradient(jnp.array([0.3, 0.4, 0.5])), rtol=1e-5)


NUMBERS = [0.5, [0.5, 0.5], np.zeros((3, 4)), []]


@pytest.mark.parametrize("rgb", [*NUMBERS, "red", None, [[0.1], [0.1, 0.2, 0.3]]])
def test_other_shapes_and_what_is_not_an_array_are_refused(traced, rgb):
    with raises(ColourError):
        evaluate(traced, rgb)


def test_other_shapes_are_refused_while_they_are_traced(traced):
    for rgb in NUMBERS:
        with raises(ColourError):
            jax.jit(evaluate)(traced, jnp.asarray(rgb))


def test_single_precision_stays_where_doubles_are_enabled(traced, doubles):
    rgb = np.array([0.5, 0.25, 0.125])
    assert evaluate(traced, rgb).dtype == np.float32
    assert jax.grad(lambda rgb: evaluate(traced, rgb).sum())(rgb).dtype == np.float64


def test_other_programs_can_filter_and_batch_it(traced):
    rgb = np.random.default_rng(1).random((100, 3)).astype(np.float32)
    by_parts = jax.lax.map(partial(evaluate, traced), rgb, batch_size=32)
    assert_allclose(by_parts, evaluate(traced, rgb), atol=1e-6)
    loss = eqx.filter_grad(lambda cube: evaluate(cube, rgb).sum())
    assert loss(traced).grid.lattice.sum() > 0
    assert repr(traced) == "TraceableCube(9 wavelengths)"
    assert repr(jax.tree.map(lambda _: 0, traced))


def test_invalid_options_are_refused(small_cube):
    with raises(OptionError):
        traceable(small_cube, [0])
    with raises(OptionError):
        traceable(small_cube, dtype=np.float16)
    for prepare in (traceable, traceable_coefficients):
        with raises(OptionError):
            prepare(small_cube, dtype=np.float64)  # not enabled
    with raises(OptionError):
        traceable_coefficients(small_cube, 5)


def test_nodes_too_close_for_float32_are_refused(plain_cube):
    nodes = plain_cube.data.lattice.nodes.copy()
    nodes[4] = nodes[3] + 1e-9
    close = Cube(replace(plain_cube.data, lattice=Lattice(nodes)))
    for prepare in (traceable, traceable_coefficients):
        with raises(OptionError):
            prepare(close)
    with jax.enable_x64(True):
        spectra = evaluate(traceable(close, AT, dtype=np.float64), nodes[[3, 3, 3]])
    assert_allclose(spectra, close.reflectance(nodes[[3, 3, 3]], AT), atol=1e-9)
