"""Seeds: nearest nodes and corners in any order of the atlas, starts between entries
and prior, and the size of lattice that an atlas needs.

Cells of the lattice of 6³ are 20 to 60 ΔE*ab long, so that corners are far from their
entries; those of 64³ are near.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import MACBETH
from tests.helpers import quiet_build
from uplift.atlas.resampling import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_1976, delta_e_spectra, rgb_to_lab
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit.base import learn_base
from uplift.fit.entries import fit_entries
from uplift.fit.families import shipped_library
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import (
    CORNER_SHARE,
    DIMS,
    FAR,
    NEAR,
    choose_lattice,
    full_entry,
    initial_guess,
    lattice_error,
    near_entry,
    seed,
)
from uplift.lattice.lattice import AXES, Lattice, axis_nodes
from uplift.models.model import reflectance
from uplift.models.moments import Moments

LATTICE = Lattice(np.linspace(0, 1, 6))
atlases = arrays(
    float,
    st.tuples(st.integers(1, 12), st.just(3)),
    elements=st.floats(0, 1),
    unique=True,
)


@given(atlases)
def test_all_corners_of_the_cells_of_entries_are_seeds_once(rgb):
    corners = LATTICE.cell_corners(LATTICE.cell(rgb)[0])
    assert_array_equal(np.sort(seed(LATTICE, rgb).points), np.unique(corners))


@given(atlases, st.randoms(use_true_random=False))
def test_seeds_do_not_depend_on_the_order_of_the_atlas(rgb, random):
    order = list(range(len(rgb)))
    random.shuffle(order)
    here = seed(LATTICE, rgb)
    there = seed(LATTICE, rgb[order])
    owners = dict(zip(here.points, here.entry, strict=True))
    assert owners == {
        point: order[entry]
        for point, entry in zip(there.points, there.entry, strict=True)
    }


def test_the_nearer_of_two_entries_owns_the_primary_point():
    rgb = np.array([[0.45, 0.4, 0.4], [0.41, 0.4, 0.4]])
    seeds = seed(LATTICE, rgb)
    assert seeds.crowded == (0,)
    assert seeds.entry[seeds.primary].tolist() == [1]


MODEL = Moments(5)
RGB = np.array([[0.33, 0.5, 0.71], [0.42, 0.42, 0.42]])
ENTRIES = np.random.default_rng(0).normal(size=(2, 5)) / 3


@pytest.fixture(scope="module")
def prior(sensor):
    return Prior(MODEL, sensor, learn_base(Problem(sensor, MODEL))[0])


def test_the_share_of_the_entry_falls_from_near_to_far_corners(prior):
    """Less for entries with narrow boxes."""
    shares = []
    for dim in (6, 12, 16, 24):
        lattice = Lattice(np.linspace(0, 1, dim))
        seeds = seed(lattice, RGB)
        nodes = lattice.points[seeds.points]
        own = ENTRIES[seeds.entry]
        distance = delta_e_1976(
            *(rgb_to_lab(prior.sensor, rgb) for rgb in (nodes, RGB[seeds.entry]))
        )
        width = seeds.half_width[seeds.entry]
        share = CORNER_SHARE * width * np.clip((FAR - distance) / (FAR - NEAR), 0, 1)
        start = initial_guess(seeds.points, nodes, prior, seeds, ENTRIES, near_entry)
        mixed = share[:, None] * MODEL.to_storage(own) + (
            1 - share[:, None]
        ) * MODEL.to_storage(prior(nodes))
        assert_allclose(MODEL.to_storage(start), mixed, atol=1e-6)
        shares.extend(share)
    assert (np.array(shares) == 0).sum() >= 5
    assert ((np.array(shares) > 0) & (np.array(shares) < 1)).sum() >= 4


def test_all_other_points_start_from_the_prior(prior):
    seeds = seed(LATTICE, RGB)
    points = np.setdiff1d(np.arange(LATTICE.size), seeds.points)
    start = initial_guess(
        points, LATTICE.points[points], prior, seeds, ENTRIES, full_entry
    )
    assert_array_equal(start, prior(LATTICE.points[points]))


@pytest.fixture(scope="module")
def stage(sensor):
    """Problem, prior and the entries of the ColorChecker."""
    spectra = on_grid(uplift.read_atlas(MACBETH), sensor.wavelengths)
    spectra = spectra[in_unit_cube(sensor.rgb(spectra))]
    lights = tuple(map(observer.light, SCENE_LIGHTS))
    problem = Problem(sensor, Moments(9), lights, lights[1])
    entries = fit_entries(problem, spectra, sensor.rgb(spectra))
    return (
        problem,
        fit_prior(problem, entries, learn_base(problem, shipped_library(), entries)[0]),
        entries,
    )


def test_lattice_error_predicts_the_error_of_the_cube(stage, sensor):
    """The lattice of the cube is evaluated at the entries without their boxes."""
    problem, prior, entries = stage
    data = quiet_build(MACBETH, dim=16, seed_corners=True).data
    trial = lattice_error(problem, data.lattice, prior, entries)
    corners, weights = data.lattice.corners(entries.rgb)
    spectra = reflectance(data.model, data.points.coefficients, sensor.wavelengths)
    answered = (weights[..., None] * spectra[corners]).sum(axis=1)
    own = reflectance(data.model, data.atlas.coefficients, sensor.wavelengths)
    plain = np.max(
        [delta_e_spectra(lit, answered, own) for lit in problem.lights], axis=0
    )
    assert_allclose(trial, plain, atol=1e-3)


def test_the_smallest_lattice_that_keeps_all_entries_is_chosen(stage):
    problem, prior, entries = stage
    _, dim, lost = choose_lattice(problem, prior, entries, 0.5)
    assert lost == 0
    for axis in AXES:
        smaller = Lattice(axis_nodes(axis, DIMS[DIMS.index(dim) - 1]))
        assert lattice_error(problem, smaller, prior, entries).max() > 0.5


def test_without_an_atlas_the_smallest_lattice_is_chosen():
    assert uplift.build(dim="auto").data.lattice.dim == DIMS[0]
