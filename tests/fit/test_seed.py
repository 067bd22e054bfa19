"""Seeding: collisions are reported, primaries come first, and the order of the atlas does not matter."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.fit.seed import seed
from uplift.lattice import Lattice

LATTICE = Lattice(np.linspace(0, 1, 6))
atlases = arrays(float, st.tuples(st.integers(1, 12), st.just(3)), elements=st.floats(0, 1), unique=True)


def nearest_points(rgb):
    apart = np.linalg.norm(LATTICE.points[None] - rgb[:, None], axis=-1)
    return apart.argmin(axis=1)


@given(atlases)
def test_every_entry_has_a_primary_point_or_a_collision(rgb):
    seeds = seed(LATTICE, rgb)
    with_primary = set(seeds.entry[seeds.primary])
    lost = {collision.lost for collision in seeds.collisions}
    assert with_primary | lost == set(range(len(rgb)))
    assert not with_primary & lost


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
    assert seeds.collisions == ()


def test_the_nearer_of_two_entries_owns_the_primary_point():
    rgb = np.array([[0.45, 0.4, 0.4], [0.41, 0.4, 0.4]])
    seeds = seed(LATTICE, rgb)
    assert seeds.collisions == ((1, 0),)
    assert seeds.entry[seeds.primary].tolist() == [1]


def test_an_empty_atlas_has_no_seeds():
    assert len(seed(LATTICE, np.zeros((0, 3))).points) == 0
