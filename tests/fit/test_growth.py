"""Growth, improvement and storage, from the prior and as in Tódová 2020, section 3.1:
any seeds fit all nodes.
"""

from functools import partial

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from tests.conftest import MACBETH
from tests.helpers import quiet_build
from uplift.colorimetry import observer
from uplift.common.progress import ignore_progress
from uplift.extras.thesis.growth_coarse import grow_coarse_to_fine
from uplift.fit.base import smooth
from uplift.fit.growth import Growth, improve
from uplift.fit.growth_outward import grow_outward, shells
from uplift.fit.prior import Prior
from uplift.fit.problem import Nodes, Problem
from uplift.fit.seeds import full_entry, initial_guess, seed
from uplift.fit.store import store
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lattice.point_table import NOT_FITTED, Status
from uplift.models.model import reflectance
from uplift.models.moments import Moments

MODEL = Moments(9)
LATTICE = Lattice(axis_nodes("srgb", 7))
NO_COLOURS = np.zeros((0, 3))
NO_SEEDS = np.zeros(0, dtype=np.int64)


def all_nodes(lattice):
    """Nodes that are fitted to their own colours, realisable or not."""
    return Nodes(lattice, np.arange(lattice.size), NO_SEEDS, NO_COLOURS)


def fitted(sensor, lattice, rgb=NO_COLOURS, grow=grow_outward):
    """Fit a lattice with entries of grey spectra at linear RGB (E, 3): table of nodes,
    improvements.
    """
    problem = Problem(sensor, MODEL)
    seeds = seed(lattice, rgb)
    prior = Prior(MODEL, sensor, smooth(MODEL, problem.forward))
    grey = np.zeros((len(rgb), MODEL.count))
    expected = partial(
        initial_guess, prior=prior, seeds=seeds, entries=grey, blend=full_entry
    )
    growth = grow(problem, all_nodes(lattice), expected, seeds.points, ignore_progress)
    improvements = improve(growth)
    return store(growth, seeds, prior), improvements


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    arrays(
        float,
        st.tuples(st.integers(0, 6), st.just(3)),
        elements=st.floats(0.02, 0.98),
        unique=True,
    )
)
def test_any_set_of_seeds_fits_the_lattice(sensor, rgb):
    points, _ = fitted(sensor, LATTICE, rgb)
    spectra = reflectance(MODEL, points.coefficients, sensor.wavelengths)
    assert np.abs(sensor.rgb(spectra) - LATTICE.points).max() <= 1e-4
    assert points.distance.max() <= 1e-4
    assert Status.UNFITTED not in points.status


def test_points_that_fail_from_their_start_are_fitted_from_their_neighbours(sensor):
    """All but the middle node start so near black that no step helps; growth proceeds
    outward from it.
    """
    middle = LATTICE.size // 2
    start = np.full((LATTICE.size, 9), -1e9) * MODEL.constant()
    start[middle] = 0
    grown = grow_coarse_to_fine(
        Problem(sensor, MODEL),
        all_nodes(LATTICE),
        lambda at, _: start[at],
        np.array([middle]),
        ignore_progress,
    )
    position = LATTICE.position(np.arange(LATTICE.size))
    steps = np.abs(position - LATTICE.dim // 2).max(axis=1)
    assert (grown.round == NOT_FITTED).sum() < 40
    assert ((grown.round >= steps) & (steps > 0)).sum() > 300


def test_growth_proceeds_outward_in_shells(sensor):
    """From the middle without seeds. Distances are those to the nearest seed, and most
    nodes have a nearer one on their way.
    """
    lattice = Lattice(axis_nodes("srgb", 9))
    position = lattice.position(np.arange(lattice.size))
    seeds = np.array([4, 300, 700])
    distance, toward = shells(lattice, seeds)
    steps = np.abs(position[:, None] - lattice.position(seeds)).max(axis=2).min(axis=1)
    assert_array_equal(distance, steps)
    assert (distance[toward] < distance).mean() > 0.8
    points, _ = fitted(sensor, lattice)
    assert (points.round == np.abs(position - 4).max(axis=1)).mean() > 0.99


@pytest.mark.parametrize(
    "rgb", [NO_COLOURS, np.array([[0.2, 0.3, 0.4]])], ids=["no seeds", "seeds"]
)
def test_the_answer_does_not_depend_on_the_order_of_growth(sensor, rgb):
    """Outward, and from coarse lattices to finer ones; few nodes differ."""
    lattice = Lattice(axis_nodes("srgb", 17))
    outward, finer = (
        fitted(sensor, lattice, rgb, grow)[0]
        for grow in (grow_outward, grow_coarse_to_fine)
    )
    position = lattice.position(np.arange(lattice.size))
    for number, stride in enumerate((4, 2, 1)):
        coarse = (position % stride == 0).all(axis=1) | (finer.entry >= 0)
        assert_array_equal(finer.round <= number, coarse)
    one, other = (
        reflectance(MODEL, points.coefficients, sensor.wavelengths)
        for points in (outward, finer)
    )
    difference = np.abs(one - other).max(axis=1)
    assert np.median(difference) < 1e-6
    assert np.quantile(difference, 0.99) < 1e-5
    assert (difference > 2e-4).mean() < 1e-3  # nearly box-shaped spectra at the faces


def test_an_unrealisable_colour_has_status_unfitted():
    """The green corner of ProPhoto RGB, not declared as unrealisable. Other nodes are
    not affected.
    """
    lattice = Lattice(np.linspace(0, 1, 3))
    points, improvements = fitted(observer.sensor("ProPhoto RGB"), lattice)
    green, grey = lattice.index(np.array([[0, 2, 0], [1, 1, 1]]))
    assert points.status[green] == Status.UNFITTED
    assert points.status[grey] == Status.REGULAR
    assert np.isfinite(points.coefficients).all()
    assert len(improvements) == 5


def test_improvement_fixes_points_with_a_vanishing_gradient(sensor):
    """Spectra so near black that only a new start helps."""
    problem = Problem(sensor, MODEL)
    growth = Growth(problem, all_nodes(LATTICE), ignore_progress)
    growth.multipliers[:, 0] = -1e9
    growth.distance[:] = LATTICE.points.max(axis=1)
    fixed = {step: fixed for step, _, fixed in improve(growth)}
    off = problem.forward.residual(growth.multipliers, LATTICE.points)
    assert (growth.distance <= 1e-4).all()
    assert_allclose(np.abs(off).max(axis=1), growth.distance, atol=1e-9)
    assert_allclose(growth.rgb, LATTICE.points - off, atol=1e-7)
    assert fixed["more iterations"] == 1  # black itself
    assert fixed["from grey"] > 300


def test_seeds_are_the_entries_with_the_coefficients_of_the_nodes():
    """The zeroth and first moments of an entry do not depend on how many are kept."""
    data = quiet_build(MACBETH, dim=16, coefficients=9, growth="neighbours").data
    points = data.points
    assert points.distance.max() <= 1e-4
    primary = points.status == Status.ATLAS_PRIMARY
    own = data.atlas.spectra.coefficients[points.entry[primary], :9]
    moved = np.abs(points.coefficients[primary] - own).max(axis=1)
    assert np.median(moved) < 0.03
