"""Growth and improvement: the lattice is fitted from any seeds, and every point has its status."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.colorimetry import observer
from uplift.common.progress import ignore_progress
from uplift.fit import Prior, Problem, Starts, fit_lattice, seed
from uplift.fit.grow import grow_from_prior, strides
from uplift.fit.growth import Growth
from uplift.fit.improve import STEPS, improve
from uplift.fit.smooth import smooth
from uplift.lattice import NOT_FITTED, Lattice, Status
from uplift.models import Moments, Sigmoid, reflectance
from uplift.models.minimum_norm import forward_map, residual

MODEL = Moments(9)
LATTICE = Lattice(observer.axis_nodes("srgb", 7))
NOBODY = np.zeros((0, 3))


def forward_of(model, sensor):
    return forward_map(model, sensor.wavelengths, sensor.matrix)


def fitted(model, sensor, lattice, rgb=NOBODY):
    """Fit a lattice with entries of grey spectra at linear RGB (E, 3)."""
    problem = Problem(model, forward_of(model, sensor), lattice)
    prior = Prior(model, sensor, smooth(model, problem.forward))
    return fit_lattice(problem, Starts(prior, seed(lattice, rgb), np.zeros((len(rgb), model.count))))


def missed(model, sensor, lattice, coefficients):
    """Distance (n,), max |linear RGB|, of stored coefficients from their targets."""
    spectra = reflectance(model, coefficients, sensor.wavelengths)
    return np.abs(sensor.rgb(spectra) - lattice.points).max(axis=1)


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(arrays(float, st.tuples(st.integers(0, 6), st.just(3)), elements=st.floats(0.02, 0.98), unique=True))
def test_any_set_of_seeds_fits_the_lattice(sensor, rgb):
    fit = fitted(MODEL, sensor, LATTICE, rgb)
    assert missed(MODEL, sensor, LATTICE, fit.points.coefficients).max() <= 1e-4
    assert fit.points.distance.max() <= 1e-4
    assert Status.UNFITTED not in fit.points.status
    assert np.isfinite(fit.points.coefficients).all()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("model", [Moments(3), MODEL, Moments(17), Sigmoid()], ids=lambda m: f"{m.name}{m.count}")
def test_tiny_lattices_are_fitted_to_their_corners(model, dim, sensor):
    lattice = Lattice(observer.axis_nodes("srgb", dim))
    fit = fitted(model, sensor, lattice)
    assert missed(model, sensor, lattice, fit.points.coefficients).max() <= 1e-4


def test_points_that_fail_from_their_start_are_fitted_from_their_neighbours(sensor):
    """All but the middle point start so near black that no step helps; growth proceeds outward from it."""
    rounds = []
    middle = LATTICE.size // 2
    start = np.full((LATTICE.size, 9), -1e9) * MODEL.constant()
    start[middle] = 0
    problem = Problem(MODEL, forward_of(MODEL, sensor), LATTICE)
    grown = grow_from_prior(problem, lambda points: start[points], np.array([middle]), rounds.append)
    steps = np.abs(LATTICE.position(np.arange(LATTICE.size)) - LATTICE.position(np.array(middle))).max(axis=1)
    fitted = grown.round != NOT_FITTED
    assert fitted.sum() > 300
    assert (grown.round[fitted & (steps > 0)] >= steps[fitted & (steps > 0)]).sum() > 300
    assert sorted({done.step for done in rounds}) == list(range(rounds[-1].step + 1))
    assert rounds[-1].done == fitted.sum()
    assert all(done.total == LATTICE.size for done in rounds)


def test_growth_proceeds_from_a_coarse_lattice_to_finer_ones(sensor):
    lattice = Lattice(observer.axis_nodes("srgb", 17))
    assert strides(lattice.dim) == [4, 2, 1]
    fit = fitted(MODEL, sensor, lattice)
    position = lattice.position(np.arange(lattice.size))
    for number, stride in enumerate(strides(lattice.dim)):
        np.testing.assert_array_equal(fit.points.round <= number, (position % stride == 0).all(axis=1))
    assert fit.improvements == ()


@pytest.mark.parametrize(("dim", "steps"), [(2, [1]), (7, [1]), (8, [2, 1]), (32, [8, 4, 2, 1])])
def test_the_coarsest_lattice_has_at_least_four_cells_an_axis(dim, steps):
    assert strides(dim) == steps


def test_the_answer_does_not_depend_on_the_order_of_growth(sensor, monkeypatch):
    """All at once, from every second node, and over three rounds; few points differ."""
    lattice = Lattice(observer.axis_nodes("srgb", 17))
    spectra = {}
    for order in ([1], [2, 1], [4, 2, 1]):
        monkeypatch.setattr("uplift.fit.grow.strides", lambda dim, order=order: order)
        points = fitted(MODEL, sensor, lattice, np.array([[0.2, 0.3, 0.4]])).points
        assert points.round.max() == len(order) - 1
        spectra[len(order)] = reflectance(MODEL, points.coefficients, sensor.wavelengths)
    for other in (2, 3):
        difference = np.abs(spectra[other] - spectra[1]).max(axis=1)
        assert np.median(difference) < 1e-6
        assert np.quantile(difference, 0.99) < 1e-5
        assert (difference > 2e-4).mean() < 1e-3  # nearly box-shaped spectra at the faces


def test_a_correction_saves_steps(sensor, monkeypatch):
    lattice = Lattice(observer.axis_nodes("srgb", 17))
    problem = Problem(MODEL, forward_of(MODEL, sensor), lattice)
    prior = Prior(MODEL, sensor, smooth(MODEL, problem.forward))
    nobody = np.zeros(0, dtype=np.int64)

    def steps():
        growth = grow_from_prior(problem, lambda points: prior(problem.goal(points)), nobody, ignore_progress)
        return growth.steps

    grown = steps()
    monkeypatch.setattr("uplift.fit.grow.strides", lambda dim: [1])
    assert grown < 0.9 * steps()


def test_an_unrealisable_colour_has_status_unfitted(sensor):
    """The green corner of ProPhoto RGB, not declared as unrealisable. Other points are not affected."""
    wide = observer.sensor("ProPhoto RGB", "D65")
    lattice = Lattice(np.linspace(0, 1, 3))
    fit = fitted(MODEL, wide, lattice)
    green = int(lattice.index(np.array([0, 2, 0])))
    grey = int(lattice.index(np.array([1, 1, 1])))
    assert fit.points.status[green] == Status.UNFITTED
    assert fit.points.status[grey] == Status.REGULAR
    assert np.isfinite(fit.points.coefficients).all()
    assert len(fit.improvements) == 5
    assert fit.improvements[0].tried > fit.improvements[0].fixed


def test_improvement_fixes_points_with_a_vanishing_gradient(sensor):
    """Spectra so near black that only a new start helps."""
    forward = forward_of(MODEL, sensor)
    growth = Growth(Problem(MODEL, forward, LATTICE), ignore_progress)
    growth.multipliers[:, 0] = -1e9
    growth.distance[:] = np.abs(residual(MODEL, forward, growth.multipliers, LATTICE.points)).max(axis=1)
    steps = improve(growth, STEPS)
    off = residual(MODEL, forward, growth.multipliers, LATTICE.points)
    assert (growth.distance <= 1e-4).all()
    np.testing.assert_allclose(np.abs(off).max(axis=1), growth.distance, atol=1e-12)
    np.testing.assert_allclose(growth.rgb, LATTICE.points - off, atol=1e-7)
    by_name = {step.step: step for step in steps}
    assert by_name["more iterations"].fixed == 1  # black itself
    assert by_name["from grey"].fixed > 300


def test_improvement_does_not_change_fitted_points(sensor):
    forward = forward_of(MODEL, sensor)
    fit = fitted(MODEL, sensor, LATTICE)
    multipliers = MODEL.from_storage(fit.points.coefficients)
    growth = Growth(Problem(MODEL, forward, LATTICE), ignore_progress)
    growth.multipliers[:], growth.distance[:] = multipliers, np.minimum(fit.points.distance, 1e-6)
    steps = improve(growth, STEPS)
    np.testing.assert_array_equal(growth.multipliers, multipliers)
    assert steps == ()
