"""Starts of lattice points: entries at their primary points, a share of them at corners, the prior elsewhere.

Cells of the lattice of 6³ are 20 to 60 ΔE*ab long, so that corners are far from their entries; those of 64³ are near.
"""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.delta_e import delta_e_1976, rgb_to_lab
from uplift.fit import ENTRY_ALONE, NO_LATTICE, CornerShare, Problem, Starts, seed
from uplift.fit.corner_share import FAR, NEAR
from uplift.fit.kriging import Kernel, Kriging
from uplift.fit.prior import Prior, smooth_base
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.models.minimum_norm import forward_map

MODEL = Moments(5)
LATTICE = Lattice(np.linspace(0, 1, 6))
RGB = np.array([[0.33, 0.5, 0.71], [0.42, 0.42, 0.42]])
ENTRIES = np.random.default_rng(0).normal(size=(2, 5)) / 3


@pytest.fixture(scope="module")
def prior(sensor):
    problem = Problem(MODEL, forward_map(MODEL, sensor.wavelengths, sensor.matrix), NO_LATTICE)
    return Prior(MODEL, sensor, smooth_base(problem, sensor))


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_corners_start_between_the_entry_and_the_prior(prior, share):
    seeds = seed(LATTICE, RGB)
    start = Starts(prior, seeds, ENTRIES, CornerShare(share, share))(seeds.points, LATTICE.points[seeds.points])
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
    return seeds, delta_e_1976(lab, own), Starts(prior, seeds, ENTRIES, share)(seeds.points, nodes)


def test_far_corners_start_from_the_prior_alone_but_the_nearest_point_from_the_entry(prior):
    seeds, distance, start = starts_by_distance(prior, LATTICE, CornerShare(near=1.0))
    far = ~seeds.primary & (distance > FAR)
    assert far.sum() >= 5
    np.testing.assert_array_equal(start[far], prior(LATTICE.points[seeds.points[far]]))
    np.testing.assert_array_equal(start[seeds.primary], ENTRIES[seeds.entry[seeds.primary]])


def test_near_corners_start_from_the_entry_alone(prior):
    seeds, distance, start = starts_by_distance(prior, Lattice(np.linspace(0, 1, 64)), CornerShare(near=1.0))
    assert distance.max() < NEAR
    np.testing.assert_array_equal(start, ENTRIES[seeds.entry])


def test_seed_corners_start_from_the_entry_at_any_distance(prior):
    seeds, distance, start = starts_by_distance(prior, LATTICE, ENTRY_ALONE)
    assert distance.max() > FAR
    np.testing.assert_array_equal(start, ENTRIES[seeds.entry])


@pytest.mark.parametrize("near", [0.5, 1.0])
def test_the_share_falls_continuously_with_distance(near):
    distance = np.linspace(0, 2 * FAR, 1001)
    share = CornerShare(near)(distance)
    assert (share[distance <= NEAR] == near).all()
    assert (share[distance >= FAR] == 0).all()
    steps = np.diff(share) / np.diff(distance)
    assert steps.max() <= 0
    assert steps.min() == pytest.approx(-near / (FAR - NEAR))


def test_all_other_points_start_from_the_prior(prior):
    seeds = seed(LATTICE, RGB)
    points = np.setdiff1d(np.arange(LATTICE.size), seeds.points)
    start = Starts(prior, seeds, ENTRIES)(points, LATTICE.points[points])
    np.testing.assert_array_equal(start, prior(LATTICE.points[points]))


def test_without_entries_all_points_start_from_the_prior(prior):
    unconstrained = Starts(prior, seed(LATTICE, np.zeros((0, 3))), np.zeros((0, 5)), CornerShare(0.5))
    points = np.arange(LATTICE.size)
    np.testing.assert_array_equal(unconstrained(points, LATTICE.points), prior(LATTICE.points))
    assert unconstrained.describe() == {}


@pytest.mark.parametrize(("nugget", "share"), [(0.0, 0.5), (0.03, 0.55), (0.3, 1.0), (2.0, 1.0)])
def test_the_share_of_entries_follows_the_nugget(prior, nugget, share):
    kriging = Kriging(np.zeros((1, 3)), np.zeros((1, 5)), Kernel(12.0, nugget))
    learnt = Prior(MODEL, prior.sensor, prior.base, kriging)
    assert learnt.corner_share.near == pytest.approx(share)
    assert learnt.corner_share.far == 0
    described = Starts(learnt, seed(LATTICE, RGB), ENTRIES, learnt.corner_share).describe()
    assert described["corner_share"] == pytest.approx(share)
