"""Seeds: nearest nodes and corners in any order of the atlas, and starts between entries and prior.

Cells of the lattice of 6³ are 20 to 60 ΔE*ab long, so that corners are far from their entries; those of 64³ are near.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.colorimetry.delta_e import delta_e_1976, rgb_to_lab
from uplift.fit.base import learn_base
from uplift.fit.kriging import Kernel, Kriging
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import FAR, FULL_ENTRY, NEAR, EntryBlend, InitialGuess, learnt_blend, seed
from uplift.lattice import Lattice
from uplift.models import Moments

LATTICE = Lattice(np.linspace(0, 1, 6))
atlases = arrays(float, st.tuples(st.integers(1, 12), st.just(3)), elements=st.floats(0, 1), unique=True)


def nearest_points(rgb):
    apart = np.linalg.norm(LATTICE.points[None] - rgb[:, None], axis=-1)
    return apart.argmin(axis=1)


@given(atlases)
def test_points_are_unique_and_corners_of_the_cell_of_their_entry(rgb):
    seeds = seed(LATTICE, rgb)
    assert len(set(seeds.points)) == len(seeds.points)
    corners, _ = LATTICE.corners(rgb)
    assert all(point in corners[entry] for point, entry in zip(seeds.points, seeds.entry, strict=True))


@given(atlases)
def test_all_corners_of_the_cells_of_entries_are_seeds(rgb):
    corners, _ = LATTICE.corners(rgb)
    assert set(seed(LATTICE, rgb).points) == set(corners.ravel())


@given(atlases, st.randoms(use_true_random=False))
def test_seeds_do_not_depend_on_the_order_of_the_atlas(rgb, random):
    order = list(range(len(rgb)))
    random.shuffle(order)
    here, there = seed(LATTICE, rgb), seed(LATTICE, rgb[order])
    owners = dict(zip(here.points, here.entry, strict=True))
    assert owners == {point: order[entry] for point, entry in zip(there.points, there.entry, strict=True)}


def test_a_single_entry_owns_the_eight_corners_nearest_first():
    rgb = np.array([[0.33, 0.5, 0.71]])
    seeds = seed(LATTICE, rgb)
    apart = np.linalg.norm(LATTICE.points[seeds.points] - rgb, axis=1)
    assert len(seeds.points) == 8
    assert (np.diff(apart) >= 0).all()
    assert seeds.primary.tolist() == [True] + 7 * [False]
    assert seeds.points[0] == nearest_points(rgb)[0]


def test_entries_in_one_cell_share_its_corners_evenly():
    rgb = np.array([[0.42, 0.42, 0.42], [0.58, 0.58, 0.58]])
    seeds = seed(LATTICE, rgb)
    assert np.bincount(seeds.entry).tolist() == [4, 4]
    assert seeds.crowded == ()


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


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_corners_start_between_the_entry_and_the_prior(prior, share):
    seeds = seed(LATTICE, RGB)
    start = InitialGuess(prior, seeds, ENTRIES, EntryBlend(share, share))(seeds.points, LATTICE.points[seeds.points])
    own = ENTRIES[seeds.entry]
    expected = prior(LATTICE.points[seeds.points])
    mixed = share * MODEL.to_storage(own) + (1 - share) * MODEL.to_storage(expected)
    np.testing.assert_array_equal(start[seeds.primary], own[seeds.primary])
    corners = ~seeds.primary
    np.testing.assert_allclose(MODEL.to_storage(start)[corners], mixed[corners], atol=1e-6)


def starts_by_distance(prior, lattice, share):
    """Seeds, their ΔE*ab from the entries, and their starts."""
    seeds = seed(lattice, RGB)
    nodes = lattice.points[seeds.points]
    lab, own = (rgb_to_lab(prior.sensor, rgb) for rgb in (nodes, RGB[seeds.entry]))
    return seeds, delta_e_1976(lab, own), InitialGuess(prior, seeds, ENTRIES, share)(seeds.points, nodes)


def test_far_corners_start_from_the_prior_alone_but_the_nearest_point_from_the_entry(prior):
    seeds, distance, start = starts_by_distance(prior, LATTICE, EntryBlend(near=1.0))
    far = ~seeds.primary & (distance > FAR)
    assert far.sum() >= 5
    np.testing.assert_array_equal(start[far], prior(LATTICE.points[seeds.points[far]]))
    np.testing.assert_array_equal(start[seeds.primary], ENTRIES[seeds.entry[seeds.primary]])


def test_seed_corners_start_from_the_entry_at_any_distance(prior):
    seeds, distance, start = starts_by_distance(prior, LATTICE, FULL_ENTRY)
    assert distance.max() > FAR
    np.testing.assert_array_equal(start, ENTRIES[seeds.entry])


@pytest.mark.parametrize("near", [0.5, 1.0])
def test_the_share_falls_continuously_with_distance(near):
    distance = np.linspace(0, 2 * FAR, 1001)
    share = EntryBlend(near)(distance)
    assert (share[distance <= NEAR] == near).all()
    assert (share[distance >= FAR] == 0).all()
    steps = np.diff(share) / np.diff(distance)
    assert steps.max() <= 0
    assert steps.min() == pytest.approx(-near / (FAR - NEAR))


def test_all_other_points_start_from_the_prior(prior):
    seeds = seed(LATTICE, RGB)
    points = np.setdiff1d(np.arange(LATTICE.size), seeds.points)
    start = InitialGuess(prior, seeds, ENTRIES)(points, LATTICE.points[points])
    np.testing.assert_array_equal(start, prior(LATTICE.points[points]))


@pytest.mark.parametrize(("nugget", "share"), [(0.0, 0.5), (0.03, 0.55), (0.3, 1.0), (2.0, 1.0)])
def test_the_share_of_entries_follows_the_nugget(prior, nugget, share):
    kriging = Kriging(np.zeros((1, 3)), np.zeros((1, 5)), Kernel(12.0, nugget))
    learnt = Prior(MODEL, prior.sensor, prior.base, kriging)
    assert learnt_blend(learnt).near == pytest.approx(share)
    assert learnt_blend(learnt).far == 0
