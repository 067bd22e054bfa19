"""Growth, improvement and storage, from the prior and as in Tódová 2020, section 3.1:
any seeds fit all nodes.
"""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from uplift import build
from uplift.colorimetry import observer
from uplift.common.progress import ignore_progress
from uplift.extras.thesis.growth_coarse import grow_coarse_to_fine, strides
from uplift.fit.base import smooth
from uplift.fit.growth import Growth, improve
from uplift.fit.growth_outward import grow_outward, shells
from uplift.fit.prior import Prior
from uplift.fit.problem import Nodes, Problem, nodes_of
from uplift.fit.seeds import full_entry, initial_guess, seed
from uplift.fit.store import MAX_LOSS, store
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lattice.point_table import NOT_FITTED, Status
from uplift.models.model import reflectance
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

MODEL = Moments(9)
LATTICE = Lattice(axis_nodes("srgb", 7))
NO_COLOURS = np.zeros((0, 3))
NO_SEEDS = np.zeros(0, dtype=np.int64)


def all_nodes(lattice):
    """Nodes that are fitted to their own colours, realisable or not."""
    return Nodes(lattice, np.arange(lattice.size), NO_SEEDS, NO_COLOURS)


def fitted(model, sensor, lattice, rgb=NO_COLOURS, grow=grow_outward):
    """Fit a lattice with entries of grey spectra at linear RGB (E, 3): table of nodes,
    improvements.
    """
    problem = Problem(sensor, model)
    nodes = all_nodes(lattice)
    seeds = seed(lattice, rgb)
    prior = prior_of(problem)
    grey = np.zeros((len(rgb), model.count))

    expected = partial(
        initial_guess, prior=prior, seeds=seeds, entries=grey, blend=full_entry
    )
    growth = grow(problem, nodes, expected, seeds.points, ignore_progress)
    improvements = improve(growth)
    return store(growth, seeds, prior), improvements


def missed(model, sensor, lattice, coefficients):
    """Distance (n,), max |linear RGB|, of stored coefficients from their targets."""
    spectra = reflectance(model, coefficients, sensor.wavelengths)
    return np.abs(sensor.rgb(spectra) - lattice.points).max(axis=1)


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
    points, _ = fitted(MODEL, sensor, LATTICE, rgb)
    assert missed(MODEL, sensor, LATTICE, points.coefficients).max() <= 1e-4
    assert points.distance.max() <= 1e-4
    assert Status.UNFITTED not in points.status
    assert np.isfinite(points.coefficients).all()


@pytest.mark.parametrize(
    ("dim", "model"), [(2, MODEL), (3, Moments(3)), (2, Sigmoid())], ids=str
)
def test_tiny_lattices_are_fitted_to_their_corners(model, dim, sensor):
    lattice = Lattice(axis_nodes("srgb", dim))
    points, _ = fitted(model, sensor, lattice)
    assert missed(model, sensor, lattice, points.coefficients).max() <= 1e-4


def test_points_that_fail_from_their_start_are_fitted_from_their_neighbours(sensor):
    """All but the middle node start so near black that no step helps; growth proceeds
    outward from it.
    """
    rounds = []
    middle = LATTICE.size // 2
    start = np.full((LATTICE.size, 9), -1e9) * MODEL.constant()
    start[middle] = 0
    grown = grow_coarse_to_fine(
        Problem(sensor, MODEL),
        all_nodes(LATTICE),
        lambda at, _: start[at],
        np.array([middle]),
        rounds.append,
    )
    steps = np.abs(
        LATTICE.position(np.arange(LATTICE.size)) - LATTICE.position(np.array(middle))
    ).max(axis=1)
    fitted = grown.round != NOT_FITTED
    assert fitted.sum() > 300
    assert (
        grown.round[fitted & (steps > 0)] >= steps[fitted & (steps > 0)]
    ).sum() > 300
    assert sorted({done.step for done in rounds}) == list(range(rounds[-1].step + 1))
    assert rounds[-1].done == fitted.sum()
    assert all(done.total == LATTICE.size for done in rounds)


def test_growth_proceeds_from_a_coarse_lattice_to_finer_ones(sensor):
    lattice = Lattice(axis_nodes("srgb", 17))
    assert strides(lattice.dim) == [4, 2, 1]
    points, improvements = fitted(MODEL, sensor, lattice, grow=grow_coarse_to_fine)
    position = lattice.position(np.arange(lattice.size))
    for number, stride in enumerate(strides(lattice.dim)):
        assert_array_equal(points.round <= number, (position % stride == 0).all(axis=1))
    assert improvements == []


def test_growth_proceeds_outward_in_shells(sensor):
    """Distances are those to the nearest seed, and most nodes have a nearer one on
    their way.
    """
    lattice = Lattice(axis_nodes("srgb", 9))
    seeds = np.array([4, 300, 700])
    distance, toward = shells(lattice, seeds)
    position = lattice.position(np.arange(lattice.size))
    steps = np.abs(position[:, None] - lattice.position(seeds)).max(axis=2).min(axis=1)
    assert_array_equal(distance, steps)
    assert np.abs(position[toward] - position).max() == 1
    assert_array_equal(np.flatnonzero(toward == np.arange(lattice.size)), seeds)
    assert (distance[toward] < distance).mean() > 0.8
    points, _ = fitted(MODEL, sensor, lattice)
    from_middle = np.abs(position - 4).max(axis=1)
    assert (points.round == from_middle).mean() > 0.99


@pytest.mark.parametrize(
    "rgb", [NO_COLOURS, np.array([[0.2, 0.3, 0.4]])], ids=["no seeds", "seeds"]
)
def test_the_answer_does_not_depend_on_the_order_of_growth(sensor, monkeypatch, rgb):
    """Outward, all at once, and from coarse lattices to finer ones; few
    nodes differ.
    """
    lattice = Lattice(axis_nodes("srgb", 17))
    spectra = [
        reflectance(
            MODEL,
            fitted(MODEL, sensor, lattice, rgb)[0].coefficients,
            sensor.wavelengths,
        )
    ]
    for order in ([1], [4, 2, 1]):
        monkeypatch.setattr(
            "uplift.extras.thesis.growth_coarse.strides", lambda dim, order=order: order
        )
        points = fitted(MODEL, sensor, lattice, rgb, grow_coarse_to_fine)[0]
        assert points.round.max() == len(order) - 1
        spectra.append(reflectance(MODEL, points.coefficients, sensor.wavelengths))
    for other in spectra[1:]:
        difference = np.abs(other - spectra[0]).max(axis=1)
        assert np.median(difference) < 1e-6
        assert np.quantile(difference, 0.99) < 1e-5
        assert (
            difference > 2e-4
        ).mean() < 1e-3  # nearly box-shaped spectra at the faces


def test_an_unrealisable_colour_has_status_unfitted(sensor):
    """The green corner of ProPhoto RGB, not declared as unrealisable. Other nodes are
    not affected.
    """
    wide = observer.sensor("ProPhoto RGB", "D65")
    lattice = Lattice(np.linspace(0, 1, 3))
    points, improvements = fitted(MODEL, wide, lattice)
    green = int(lattice.index(np.array([0, 2, 0])))
    grey = int(lattice.index(np.array([1, 1, 1])))
    assert points.status[green] == Status.UNFITTED
    assert points.status[grey] == Status.REGULAR
    assert np.isfinite(points.coefficients).all()
    assert len(improvements) == 5
    assert improvements[0][1] > improvements[0][2]


def test_improvement_fixes_points_with_a_vanishing_gradient(sensor):
    """Spectra so near black that only a new start helps."""
    problem = Problem(sensor, MODEL)
    growth = Growth(problem, all_nodes(LATTICE), ignore_progress)
    forward = problem.forward
    growth.multipliers[:, 0] = -1e9
    growth.distance[:] = np.abs(
        forward.residual(growth.multipliers, LATTICE.points)
    ).max(axis=1)
    steps = improve(growth)
    off = forward.residual(growth.multipliers, LATTICE.points)
    assert (growth.distance <= 1e-4).all()
    assert_allclose(np.abs(off).max(axis=1), growth.distance, atol=1e-12)
    assert_allclose(growth.rgb, LATTICE.points - off, atol=1e-7)
    fixed = {step: fixed for step, _, fixed in steps}
    assert fixed["more iterations"] == 1  # black itself
    assert fixed["from grey"] > 300


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_seeds_are_the_entries_with_the_coefficients_of_the_nodes(repository):
    """The zeroth and first moments of an entry do not depend on how many are kept."""
    cube = build(
        repository / "atlases" / "macbeth.txt",
        dim=16,
        coefficients=9,
        growth="neighbours",
    )
    points = cube.data.points
    entries = cube.data.atlas.spectra.coefficients
    assert points.distance.max() <= 1e-4
    primary = points.status == Status.ATLAS_PRIMARY
    moved = np.abs(
        points.coefficients[primary] - entries[points.entry[primary], :9]
    ).max(axis=1)
    assert np.median(moved) < 0.03


STORED = Lattice(axis_nodes("srgb", 9))


@pytest.fixture(scope="module")
def problem():
    return Problem(observer.sensor(), MODEL)


def prior_of(problem):
    return Prior(problem.model, problem.sensor, smooth(problem.model, problem.forward))


def distance(problem, coefficients):
    """Distance evaluated by numpy, as a lookup does."""
    return np.abs(
        problem.forward.residual(
            problem.model.from_storage(coefficients), STORED.points
        )
    ).max(axis=1)


def greys(problem, level):
    """Multipliers of a flat spectrum per node."""
    return np.tan(np.pi * (np.asarray(level) - 0.5))[:, None] * problem.model.constant()


def grown(problem, multipliers):
    """Growth that ended with multipliers (n, C)."""
    growth = Growth(problem, nodes_of(STORED, problem.sensor), ignore_progress)
    growth.multipliers[:] = multipliers
    off = problem.forward.residual(multipliers, STORED.points)
    growth.distance[:] = np.abs(off).max(axis=1)
    growth.rgb[:] = STORED.points - off
    return growth


def test_single_precision_is_used_where_it_is_accurate(problem):
    multipliers = greys(problem, np.linspace(0.001, 0.999, STORED.size))
    here = distance(problem, problem.model.to_storage(multipliers))
    stored = store(
        grown(problem, multipliers), seed(STORED, NO_COLOURS), prior_of(problem)
    )
    assert stored.coefficients.dtype == np.float32
    assert_allclose(stored.distance, distance(problem, stored.coefficients), atol=1e-6)
    assert (stored.distance <= here + MAX_LOSS * problem.threshold).all()


def test_double_precision_is_used_where_single_is_inaccurate(problem, monkeypatch):
    """The threshold is so small that rounding exceeds it in the last block: all nodes
    are evaluated again.
    """
    monkeypatch.setattr("uplift.fit.growth.BLOCK_POINTS", 256)
    strict = replace(problem, threshold=1e-7)
    multipliers = greys(
        problem,
        np.concatenate([np.full(STORED.size - 9, 0.5), np.linspace(0.99, 0.9999, 9)]),
    )
    coefficients = problem.model.to_storage(multipliers)
    here = distance(problem, coefficients)
    stored = store(
        grown(strict, multipliers), seed(STORED, NO_COLOURS), prior_of(problem)
    )
    assert stored.coefficients.dtype == np.float64
    assert_allclose(stored.coefficients, coefficients, atol=1e-12)
    assert_allclose(stored.distance, here, atol=1e-7)
