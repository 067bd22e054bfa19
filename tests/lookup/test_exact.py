"""Exact colours where nodes are unrealisable: docs/mathematics.md, 9."""

import pickle
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from uplift.colorimetry.object_colours import solid
from uplift.lookup.refine import within_solid
from uplift.models.model import reflectance

GREYS = np.linspace(0, 1, 33)[:, None].repeat(3, axis=1)
EXACT_MODES = ("spectra", "refined")


@pytest.fixture(scope="module")
def colours():
    return np.random.default_rng(3).uniform(0, 1, (600, 3))


def inside(cube, rgb, depth=0.0):
    return solid(cube.data.sensor.matrix).signed_distance(rgb) < -depth


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_realisable_colours_are_exact(wide_cube, colours, mode):
    rgb = np.concatenate([colours, colours**3, GREYS, [[0.356, 0.082, 0.002]]])
    for cube in (wide_cube, uplift.load("acescg")):
        realisable = rgb[cube.data.solid.contains(rgb)]
        found = cube.data.sensor.rgb(cube.reflectance(realisable, mode=mode))
        assert_allclose(found, realisable, rtol=0, atol=1e-4)


def test_coefficients_of_realisable_colours_have_them(wide_cube, colours):
    """Mixtures of the coefficients of unrealisable nodes miss them by up to 0.1."""
    realisable = colours[inside(wide_cube, colours, 0.01)]
    found = reflectance(
        wide_cube.data.model,
        uplift.bulk.coefficients(wide_cube)(realisable),
        wide_cube.wavelengths,
    )
    assert_allclose(wide_cube.data.sensor.rgb(found), realisable, rtol=0, atol=1e-4)


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_unrealisable_colours_become_the_nearest_realisable_of_their_hue(
    wide_cube, colours, mode
):
    sensor = wide_cube.data.sensor
    outside = colours[~inside(wide_cube, colours)]
    assert len(outside) >= 20
    goal = within_solid(wide_cube.data, outside)
    answers = wide_cube.reflectance(outside, mode=mode)
    assert ((answers >= 0) & (answers <= 1)).all()
    off = np.abs(sensor.rgb(answers) - goal)
    assert off.max() <= 0.02
    assert np.median(off) <= 1e-4
    assert_allclose(sensor.xyz(goal)[:, 1], sensor.xyz(outside)[:, 1], atol=1e-9)


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_answers_are_continuous_across_the_boundary_of_the_solid(wide_cube, mode):
    grey = np.full(3, 0.3)
    path = grey + np.linspace(0.7, 1, 101)[:, None] * ([0.9, 0.05, 0.02] - grey)
    assert 0 < inside(wide_cube, path).mean() < 1
    found = wide_cube.data.sensor.rgb(wide_cube.reflectance(path, mode=mode))
    steps, wanted = (np.abs(np.diff(rgb, axis=0)).max() for rgb in (found, path))
    assert steps <= 1.5 * wanted


def test_weighted_coefficients_are_continuous_across_cells():
    """They miss their colours, so that a move in some cells alone would be a step at
    their faces.
    """
    cube = uplift.load("acescg")
    assert 0 < cube.data.inexact_cells.mean() < 0.9
    rng = np.random.default_rng(5)
    middle = rng.random((500, 3))
    middle[:, 0] = rng.choice(cube.data.lattice.nodes[1:-1], 500)
    for lookup in (partial(cube.reflectance, mode="moments"), cube.coefficients):
        before, after = (
            lookup(middle + np.array([side, 0, 0])) for side in (-1e-9, 1e-9)
        )
        assert np.abs(after - before).max() <= 1e-4


def test_tables_and_the_bulk_query_have_the_same_answers(wide_cube, colours):
    """Unrealisable ones are nearly boxes."""
    few = [wide_cube.reflectance(part) for part in np.array_split(colours, 60)]
    expected = np.concatenate(few)
    assert_allclose(wide_cube.reflectance(colours), expected, atol=1e-6)
    sampler = uplift.bulk.spectra(wide_cube)
    assert_allclose(sampler(colours), expected, atol=2e-6)
    assert_array_equal(pickle.loads(pickle.dumps(sampler))(colours), sampler(colours))


def test_an_entry_in_an_inexact_cell_keeps_its_spectrum(wide_cube):
    rgb = wide_cube.data.atlas.rgb
    near = np.clip(rgb + np.random.default_rng(0).uniform(-0.05, 0.05, (40, 3)), 0, 1)
    back = wide_cube.data.sensor.rgb(wide_cube.reflectance(near))
    assert_allclose(back, near, rtol=0, atol=1e-5)
    own = wide_cube.data.atlas.spectra.reflectance([0], wide_cube.wavelengths)
    assert_allclose(wide_cube.reflectance(rgb), own, atol=1e-5)
