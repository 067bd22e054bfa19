"""Exact colours where nodes are unrealisable: docs/mathematics.md, 9."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.object_colours import solid
from uplift.lookup.refine import with_colours, within_solid
from uplift.models.model import evaluate

GREYS = np.linspace(0, 1, 33)[:, None].repeat(3, axis=1)
EXACT_MODES = ("spectra", "refined")


@pytest.fixture(scope="module")
def wide():
    """A coarse cube of ITU-R BT.2020: each of its cells has an unrealisable corner."""
    return uplift.build(dim=3, space="ITU-R BT.2020")


@pytest.fixture(scope="module")
def colours():
    return np.random.default_rng(3).uniform(0, 1, (600, 3))


def delta_e(cube, rgb, spectra):
    return delta_e_rgb(cube.data.sensor, rgb, cube.data.sensor.rgb(spectra))


def inside(cube, rgb, depth=0.0):
    return solid(cube.data.sensor.matrix).signed_distance(rgb) < -depth


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_realisable_colours_are_exact(wide, colours, mode):
    for cube in (wide, uplift.load("acescg")):
        realisable = np.concatenate(
            [colours, colours**3, GREYS, [[0.356, 0.082, 0.002]]]
        )
        realisable = realisable[cube.data.solid.contains(realisable)]
        found = cube.data.sensor.rgb(cube.reflectance(realisable, mode=mode))
        assert_allclose(found, realisable, rtol=0, atol=1e-4)


def test_spectra_that_nearly_have_their_colours_hardly_move(wide):
    """A step from 1e-5 to 0.9 stays, if its colour is 1e-7 from the requested one."""
    sensor = wide.data.sensor
    step = np.where((sensor.wavelengths > 480) & (sensor.wavelengths < 620), 0.9, 1e-5)[
        None
    ]
    requested = sensor.rgb(step) + 2e-7 * (0.5 - sensor.rgb(step))
    moved = with_colours(wide.data, step, step, requested, sensor.wavelengths)
    assert 0 < np.abs(moved - step).max() < 1e-4


def test_coefficients_of_realisable_colours_have_them(wide, colours):
    """Mixtures of the coefficients of unrealisable nodes miss them by up to 0.1."""
    realisable = colours[inside(wide, colours, 0.01)]
    found = wide.data.model.from_storage(uplift.bulk.coefficients(wide)(realisable))
    found = evaluate(wide.data.model, found, wide.wavelengths)
    assert_allclose(wide.data.sensor.rgb(found), realisable, rtol=0, atol=1e-4)


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_unrealisable_colours_become_the_nearest_realisable_of_their_hue(
    wide, colours, mode
):
    sensor = wide.data.sensor
    outside = colours[~inside(wide, colours)]
    assert len(outside) >= 20
    goal = within_solid(wide.data, outside)
    answers = wide.reflectance(outside, mode=mode)
    assert ((answers >= 0) & (answers <= 1)).all()
    assert np.abs(sensor.rgb(answers) - goal).max() <= 0.02
    assert np.median(np.abs(sensor.rgb(answers) - goal)) <= 1e-4
    assert_allclose(sensor.xyz(goal)[:, 1], sensor.xyz(outside)[:, 1], atol=1e-9)


@pytest.mark.parametrize("mode", EXACT_MODES)
def test_answers_are_continuous_across_the_boundary_of_the_solid(wide, mode):
    grey = np.full(3, 0.3)
    target = np.array([0.9, 0.05, 0.02])
    path = grey + np.linspace(0.7, 1, 101)[:, None] * (target - grey)
    assert inside(wide, path).any()
    assert not inside(wide, path).all()
    found = wide.data.sensor.rgb(wide.reflectance(path, mode=mode))
    assert (
        np.abs(np.diff(found, axis=0)).max()
        <= 1.5 * np.abs(np.diff(path, axis=0)).max()
    )


def test_weighted_coefficients_are_continuous_across_cells():
    """They miss their colours, so that a move in some cells alone would be a step at
    their faces.
    """
    cube = uplift.load("acescg")
    assert 0 < cube.data.inexact_cells.mean() < 0.9
    middle = np.random.default_rng(5).uniform(0, 1, (500, 3))
    middle[:, 0] = np.random.default_rng(6).choice(cube.data.lattice.nodes[1:-1], 500)
    before, after = (middle + np.array([side, 0, 0]) for side in (-1e-9, 1e-9))
    change = cube.reflectance(after, mode="moments") - cube.reflectance(
        before, mode="moments"
    )
    assert np.abs(change).max() <= 1e-4
    assert np.abs(cube.coefficients(after) - cube.coefficients(before)).max() <= 1e-4


def test_tables_and_the_bulk_query_have_the_same_answers(wide, colours):
    few = np.concatenate(
        [wide.reflectance(part) for part in np.array_split(colours, 60)]
    )
    assert_allclose(
        wide.reflectance(colours), few, atol=1e-6
    )  # unrealisable ones are nearly boxes
    sampler = uplift.bulk.spectra(wide)
    assert_allclose(sampler(colours), few, atol=2e-6)
    assert_array_equal(pickle.loads(pickle.dumps(sampler))(colours), sampler(colours))


def test_an_entry_in_an_inexact_cell_keeps_its_spectrum():
    spectrum = uplift.Entry("paint", np.array([380.0, 780.0]), np.array([0.2, 0.5]))
    cube = uplift.build(uplift.Atlas((spectrum,)), dim=3, space="ITU-R BT.2020")
    rgb = cube.data.atlas.rgb
    near = np.clip(rgb + np.random.default_rng(0).uniform(-0.05, 0.05, (40, 3)), 0, 1)
    assert delta_e(cube, near, cube.reflectance(near)).max() <= 0.001
    assert_allclose(
        cube.reflectance(rgb),
        cube.data.atlas.spectra.reflectance([0], cube.wavelengths),
        atol=1e-5,
    )
