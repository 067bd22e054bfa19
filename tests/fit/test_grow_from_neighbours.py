"""Growth outward from seeds or from the middle, as in Tódová 2020, section 3.1."""

from __future__ import annotations

import numpy as np
import pytest

from uplift import build, read_atlas
from uplift.colorimetry import observer
from uplift.common.progress import ignore_progress
from uplift.fit import Problem
from uplift.fit.grow_from_neighbours import grow_from_neighbours
from uplift.lattice import NOT_FITTED, Lattice, Status
from uplift.models import Moments, Sigmoid
from uplift.models.minimum_norm import forward_map

LATTICE = Lattice(observer.axis_nodes("srgb", 7))
NOBODY = np.zeros(0, dtype=np.int64)


def problem_of(model, sensor, active=None):
    return Problem(model, forward_map(model, sensor.wavelengths, sensor.matrix), LATTICE, active_points=active)


def grey(points):
    return np.zeros((len(points), 9))


def steps_from(points):
    """Steps (n,) from every point to the nearest of ``points``."""
    position = LATTICE.position(np.arange(LATTICE.size))
    return np.abs(position[:, None] - LATTICE.position(points)).max(axis=2).min(axis=1)


def test_without_seeds_rounds_are_the_shells_around_the_middle(sensor):
    growth = grow_from_neighbours(problem_of(Moments(9), sensor), grey, NOBODY, ignore_progress)
    assert growth.round[LATTICE.size // 2] == 0
    assert (growth.round != NOT_FITTED).mean() > 0.95
    late = growth.round > steps_from(np.array([LATTICE.size // 2]))
    assert late.mean() < 0.05


def test_rounds_are_the_shells_around_the_seeds(sensor):
    seeds = np.array([0 + LATTICE.index(np.array(p)) for p in ((1, 1, 1), (5, 4, 2))])
    growth = grow_from_neighbours(problem_of(Moments(9), sensor), grey, seeds, ignore_progress)
    fitted = growth.round != NOT_FITTED
    assert (growth.round[seeds] == 0).all()
    assert (growth.round[fitted] >= steps_from(seeds)[fitted]).all()
    assert growth.round.max() < 6


def test_only_active_points_are_fitted(sensor):
    active = np.flatnonzero(LATTICE.points[:, 0] < 0.2)
    growth = grow_from_neighbours(problem_of(Moments(9), sensor, active), grey, NOBODY, ignore_progress)
    assert not np.isfinite(growth.distance[np.setdiff1d(np.arange(LATTICE.size), active)]).any()
    assert (growth.round[active] != NOT_FITTED).mean() > 0.9


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
@pytest.mark.parametrize("model", ["moments", "sigmoid"])
@pytest.mark.parametrize("with_atlas", [True, False])
def test_whole_builds_end_at_the_threshold(repository, model, with_atlas):
    atlas = read_atlas(repository / "atlases" / "macbeth.txt") if with_atlas else None
    cube = build(atlas, dim=7, model=model, start="neighbours", debug=True)
    points = cube.data.points
    assert points.distance.max() <= 1e-4
    assert Status.UNFITTED not in points.status
    assert points.round.max() >= 2
    assert isinstance(cube.data.model, Moments if model == "moments" else Sigmoid)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_corners_start_from_the_entry_however_far_they_are(repository):
    """Those of 5³ are: from the prior, their starts depend on whether this is forced."""
    atlas = read_atlas(repository / "atlases" / "macbeth.txt")

    def corners(start, seed_corners):
        points = build(atlas, dim=5, start=start, seed_corners=seed_corners).data.points
        return points.coefficients[points.status == Status.ATLAS_CORNER]

    np.testing.assert_array_equal(corners("neighbours", False), corners("neighbours", True))
    assert not np.allclose(corners("prior", False), corners("prior", True), atol=0.01)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_seeds_are_the_entries_with_the_coefficients_of_the_nodes(repository):
    """The zeroth and first moments of an entry do not depend on how many are kept."""
    cube = build(repository / "atlases" / "macbeth.txt", dim=16, coefficients=9, start="neighbours")
    points, entries = cube.data.points, cube.data.atlas.spectra.coefficients
    primary = points.status == Status.ATLAS_PRIMARY
    moved = np.abs(points.coefficients[primary] - entries[points.entry[primary], :9]).max(axis=1)
    assert np.median(moved) < 0.03
