"""The solver against scipy, as a solver of optimistix, and with any other solver of optimistix in its place."""

from __future__ import annotations

import jax
import numpy as np
import optimistix
import pytest
from scipy.optimize import least_squares, minimize

from tests.helpers import raises, residual
from uplift import build
from uplift.colorimetry.lights import SCENE_LIGHTS
from uplift.colorimetry.observer import light
from uplift.common.errors import UpliftError
from uplift.fit import optimistix_solvers
from uplift.fit.batch import CPU_BATCH_ROWS
from uplift.fit.entries import fit_entries, objective
from uplift.fit.optimistix_solvers import LeastChange, stock_solver
from uplift.fit.problem import Problem
from uplift.fit.solver import solve
from uplift.models import Moments, Sigmoid, evaluate
from uplift.models.minimum_norm import forward_map
from uplift.pipeline.options import CUSTOM

RNG = np.random.default_rng(2)
TARGETS = RNG.uniform(0.05, 0.95, (40, 3))
MODEL = Moments(5)
INNER = RNG.uniform(0.2, 0.8, (6, 3))
PRIORS = RNG.normal(size=(6, 5)) / 5
SMALL = {"dim": 4, "coefficients": 5, "entry_coefficients": 5}


@pytest.mark.parametrize("model", [Moments(9), Sigmoid()], ids=["moments", "sigmoid"])
def test_distances_are_at_most_those_of_scipy(model, sensor):
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(forward, np.zeros((40, model.count)), TARGETS, tolerance=1e-9, max_passes=40)
    for target, distance in zip(TARGETS, found.distance, strict=True):
        oracle = least_squares(
            lambda p, target=target: residual(forward, p[None], target[None])[0], np.zeros(model.count)
        )
        assert distance <= 1e-9 or distance <= np.abs(oracle.fun).max() * 1.01


def test_three_unknowns_have_the_multipliers_of_scipy(sensor):
    """With as many unknowns as equations the solution is unique."""
    model = Sigmoid()
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(forward, np.zeros((40, 3)), TARGETS, tolerance=1e-12, max_passes=40)
    for target, multipliers in zip(TARGETS[:8], found.multipliers, strict=False):
        oracle = least_squares(
            lambda p, target=target: residual(forward, p[None], target[None])[0],
            np.zeros(3),
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
        )
        np.testing.assert_allclose(multipliers, oracle.x, rtol=1e-5, atol=1e-6)


def test_no_distance_increases(sensor):
    """Unrealisable targets are not an error: the distance reports them."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    wild = RNG.uniform(-1, 2, (50, 3))
    start = RNG.normal(size=(50, 9))
    before = (residual(forward, start, wild) ** 2).sum(axis=1)
    found = solve(forward, start, wild, tolerance=1e-6, max_passes=3)
    after = (residual(forward, found.multipliers, wild) ** 2).sum(axis=1)
    assert (after <= before * (1 + 1e-12)).all()
    assert np.isfinite(found.multipliers).all()
    assert (found.distance > 1e-6).any()


@pytest.mark.parametrize("max_passes", [1, 12])
def test_solutions_do_not_depend_on_the_batch(sensor, max_passes):
    """A problem has the same solution alone and among many, also if it is hard or abandoned."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    dark, wild = [[2e-4, 1e-3, 1e-5]], [[0.9, 0.0, 0.9], [1.2, -0.3, 0.5]]
    few = np.concatenate([TARGETS[:5], dark, wild])
    many = np.resize(few, (CPU_BATCH_ROWS[0] + len(few), 3))
    crowd = solve(forward, np.zeros((len(many), 9)), many, tolerance=1e-8, max_passes=max_passes)
    for row, target in enumerate(few):
        alone = solve(forward, np.zeros((1, 9)), target[None], tolerance=1e-8, max_passes=max_passes)
        for found in (row, row + len(many) - len(few)):
            np.testing.assert_allclose(crowd.multipliers[found], alone.multipliers[0], rtol=1e-9)


@pytest.fixture(scope="module")
def forward(sensor):
    return forward_map(MODEL, sensor.wavelengths, sensor.matrix)


def test_optimistix_runs_it(forward):
    with jax.enable_x64(True):
        found = optimistix.least_squares(
            lambda y, target: residual(forward, y, target),
            LeastChange(forward, 1e-9),
            PRIORS,
            args=INNER,
        )
    off = residual(forward, np.asarray(found.value), INNER)
    assert np.abs(off).max() <= 1e-9
    ours = solve(forward, PRIORS, INNER, tolerance=1e-9, max_passes=20, prior=PRIORS)
    np.testing.assert_allclose(found.value, ours.multipliers, atol=1e-9)


def test_the_answer_is_the_nearest_to_the_prior(forward):
    """scipy minimises the distance from the prior under the constraint of the colour."""
    found = solve(forward, PRIORS, INNER, tolerance=1e-12, max_passes=40, prior=PRIORS)
    for prior, target, multipliers in zip(PRIORS, INNER, found.multipliers, strict=True):
        oracle = minimize(
            lambda p, prior=prior: ((forward.inverse_root @ (p - prior)) ** 2).sum(),
            prior,
            method="SLSQP",
            tol=1e-14,
            constraints={
                "type": "eq",
                "fun": lambda p, target=target: residual(forward, p[None], target[None])[0],
            },
        )
        np.testing.assert_allclose(multipliers, oracle.x, atol=2e-4)


def test_the_answer_does_not_depend_on_the_start(forward):
    starts = PRIORS + 0.05 * RNG.normal(size=PRIORS.shape)
    one, other = (
        solve(forward, start, INNER, tolerance=1e-12, max_passes=40, prior=PRIORS) for start in (PRIORS, starts)
    )
    np.testing.assert_allclose(one.multipliers, other.multipliers, atol=1e-5)
    without = solve(forward, starts, INNER, tolerance=1e-12, max_passes=40)
    assert np.abs(without.multipliers - one.multipliers).max() > 1e-3


def test_stock_solvers_give_the_same_cube():
    """Nodes on the faces have nearly box-shaped spectra: there the default stops to pull towards the prior."""
    dogleg = optimistix.Dogleg(rtol=1e-8, atol=1e-8)
    cubes = [build(**SMALL, solver=solver) for solver in ("least-change", "gauss-newton", dogleg)]
    assert [cube.data.provenance["options"]["solver"] for cube in cubes[1:]] == ["gauss-newton", CUSTOM]
    sensor, nodes = cubes[0].data.sensor, cubes[0].data.lattice.points
    default, *stock = (
        evaluate(MODEL, MODEL.from_storage(cube.data.points.coefficients), sensor.wavelengths) for cube in cubes
    )
    inner = ~np.isin(nodes, (0, 1)).any(axis=1)
    for spectra in stock:
        assert np.abs(spectra[inner] - default[inner]).max() <= 1e-5
        assert np.abs(spectra - default).max() <= 0.2
    assert np.abs(stock[0] - stock[1]).max() <= 1e-5
    assert max(cube.data.points.distance.max() for cube in cubes) <= 1e-4


def test_entries_are_those_of_minpack(sensor):
    rng = np.random.default_rng(1)
    measured = 0.5 + 0.4 * np.sin(sensor.wavelengths / 60 + rng.uniform(0, 6, (3, 1)))
    lights = tuple(light(name) for name in SCENE_LIGHTS)
    ours, theirs = (
        fit_entries(Problem(sensor, MODEL, lights, light("A"), 1e-6, solver), measured, sensor.rgb(measured))
        for solver in (None, stock_solver("levenberg-marquardt", 1e-8))
    )
    spectra = [evaluate(MODEL, each.multipliers, sensor.wavelengths) for each in (ours, theirs)]
    np.testing.assert_allclose(*spectra, atol=1e-4)
    np.testing.assert_allclose(theirs.error, ours.error, atol=1e-4)


def test_a_solver_that_stops_early_is_an_error(sensor):
    measured = 0.5 + 0.4 * np.sin(sensor.wavelengths / 60)[None]
    goal = objective(Problem(sensor, MODEL, (light("A"),)))
    with raises(UpliftError, "solver-failed"):
        optimistix_solvers.minimise(optimistix.GaussNewton(rtol=10.0, atol=10.0), goal, measured)
