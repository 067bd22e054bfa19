"""Growth and improvement: the lattice is fitted from any seeds, and every point has its status."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.colorimetry import observer
from uplift.fit import Prior, Problem, fit_lattice, seed
from uplift.fit.grow import grow
from uplift.fit.improve import improve
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
    prior = Prior(sensor, smooth(model, problem.forward))
    return fit_lattice(problem, seed(lattice, rgb), np.zeros((len(rgb), model.count)), prior)


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
@pytest.mark.parametrize(
    "model", [Moments(3), MODEL, Moments(17), Sigmoid()], ids=lambda m: f"{m.name}{m.count}"
)
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
    grown = grow(
        Problem(MODEL, forward_of(MODEL, sensor), LATTICE), lambda points: start[points], rounds.append
    )
    steps = np.abs(LATTICE.position(np.arange(LATTICE.size)) - LATTICE.position(np.array(middle))).max(axis=1)
    fitted = grown.round != NOT_FITTED
    assert fitted.sum() > 300
    assert (grown.round[fitted & (steps > 0)] >= steps[fitted & (steps > 0)]).sum() > 300
    assert [done.step for done in rounds] == list(range(len(rounds)))
    assert rounds[-1].done == fitted.sum()
    assert all(done.total == LATTICE.size for done in rounds)


def test_all_points_are_fitted_from_the_prior_in_the_first_round(sensor):
    fit = fitted(MODEL, sensor, LATTICE)
    assert (fit.points.round == 0).all()
    assert fit.improvements == ()


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
    stuck = np.zeros((LATTICE.size, 9))
    stuck[:, 0] = -1e9
    distance = np.abs(residual(MODEL, forward, stuck, LATTICE.points)).max(axis=1)
    steps = improve(Problem(MODEL, forward, LATTICE), stuck, distance)
    assert (distance <= 1e-4).all()
    np.testing.assert_allclose(
        np.abs(residual(MODEL, forward, stuck, LATTICE.points)).max(axis=1), distance, atol=1e-12
    )
    by_name = {step.step: step for step in steps}
    assert by_name["more iterations"].fixed == 1  # black itself
    assert by_name["from grey"].fixed > 300


def test_improvement_does_not_change_fitted_points(sensor):
    forward = forward_of(MODEL, sensor)
    fit = fitted(MODEL, sensor, LATTICE)
    multipliers = MODEL.from_storage(fit.points.coefficients)
    again = multipliers.copy()
    steps = improve(Problem(MODEL, forward, LATTICE), again, np.minimum(fit.points.distance, 1e-6))
    np.testing.assert_array_equal(again, multipliers)
    assert steps == ()
