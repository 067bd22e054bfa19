"""Derivatives of traced spectra: those of finite differences, in both directions."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from uplift.lookup.interpolate import is_inexact
from uplift.lookup.traceable import evaluate, traceable

STEP = 1e-7


@pytest.fixture(params=["small_cube", "wide_cube", "wide_sigmoid_cube"])
def cube(request):
    return request.getfixturevalue(request.param)


def colours(cube):
    """Colours anywhere, dark ones, and those around entries; one is NaN."""
    rng = np.random.default_rng(8)
    around = cube.data.atlas.rgb + rng.uniform(-0.05, 0.05, (10, 1, 3))
    rgb = [rng.random((200, 3)), rng.random((100, 3)) ** 3, *around]
    rgb = np.clip(np.concatenate(rgb), 0.001, 0.999)
    rgb[0] = np.nan
    return rgb


def test_derivatives_are_finite_differences(cube, doubles):
    """In a random direction of colours, of spectra of nodes and of entries at once."""
    rng = np.random.default_rng(3)
    traced = traceable(cube, dtype=np.float64)
    rgb = colours(cube)
    start = (rgb, np.asarray(traced.grid.lattice), np.asarray(traced.grid.atlas))
    directions = tuple(rng.normal(size=array.shape) for array in start)

    def spectra(rgb, lattice, atlas):
        grid = traced.grid._replace(lattice=lattice, atlas=atlas)
        return evaluate(replace(traced, grid=grid), rgb)

    found = np.asarray(jax.jvp(spectra, start, directions)[1])
    assert np.isfinite(found).all()
    before = [at - STEP * to for at, to in zip(start, directions, strict=True)]
    after = [at + STEP * to for at, to in zip(start, directions, strict=True)]
    difference = np.asarray(spectra(*after) - spectra(*before)) / (2 * STEP)
    off = np.abs(found - difference) / np.maximum(np.abs(difference), 1)
    # Facets of the solid, and faces of cells and boxes, may lie within a step of a few.
    deep = cube.data.solid.signed_distance(rgb) < -1e-3
    assert np.quantile(off[deep], 0.98) < 1e-3
    # Spectra that are moved have the requested colours: both rise alike.
    if traced.moves is not None:
        deep[deep] = is_inexact(cube.data, rgb[deep])
        assert deep.sum() > 50
        rise = cube.data.sensor.rgb(found[deep])
        assert_allclose(rise, directions[0][deep], atol=1e-6)
    weights = rng.random(found.shape)
    gradients = jax.grad(
        lambda *arrays: jnp.nansum(weights * spectra(*arrays)), (0, 1, 2)
    )(*start)
    along = sum(
        np.nansum(gradient * direction)
        for gradient, direction in zip(gradients, directions, strict=True)
    )
    assert_allclose(along, np.nansum(weights * found), rtol=1e-6)


def test_gradients_outside_are_zero_and_at_the_ends_those_of_the_inside(small_cube):
    traced = traceable(small_cube, [400, 500, 600])
    gradient = jax.grad(lambda rgb: evaluate(traced, rgb).sum())
    assert_array_equal(gradient(jnp.array([1.5, -0.2, 0.5]))[:2], 0)
    for end, near in ((0.0, 1e-5), (1.0, 1 - 1e-5)):
        at_end, inside = (gradient(jnp.array([red, 0.3, 0.6])) for red in (end, near))
        assert_allclose(at_end, inside, rtol=0.01)
