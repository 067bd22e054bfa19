"""The solver against scipy, run by optimistix itself, and with any other solver of
optimistix in its place.
"""

import os

import jax
import numpy as np
import optimistix
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import least_squares, minimize

from tests.conftest import MACBETH
from tests.helpers import run_python
from uplift import build, load
from uplift.fit.batch import CPU_ROWS
from uplift.fit.solver import LeastChange, solve
from uplift.models.minimum_norm import forward_map
from uplift.models.model import reflectance
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.options import CUSTOM

RNG = np.random.default_rng(2)
TARGETS = RNG.uniform(0.05, 0.95, (24, 3))
MODEL = Moments(5)
INNER = RNG.uniform(0.2, 0.8, (6, 3))
PRIORS = RNG.normal(size=(6, 5)) / 5


@pytest.mark.parametrize("model", [Moments(9), Sigmoid()], ids=["moments", "sigmoid"])
def test_distances_are_at_most_those_of_scipy(model, sensor):
    """With as many unknowns as equations the solution is unique."""
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    start = np.zeros((len(TARGETS), model.count))
    found = solve(forward, start, TARGETS, tolerance=1e-9, max_passes=40)
    for row, multipliers in enumerate(found.multipliers):
        oracle = least_squares(
            lambda p, row=row: forward.residual(p[None], TARGETS[[row]])[0],
            start[row],
            xtol=1e-15,
        )
        missed = np.abs(oracle.fun).max()
        assert found.distance[row] <= max(1e-9, 1.01 * missed)
        if model.count == 3 and missed <= 1e-9:
            assert_allclose(multipliers, oracle.x, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("max_passes", [1, 12])
def test_solutions_do_not_depend_on_the_batch(sensor, max_passes):
    """A problem has the same solution alone and among many, also if it is hard or
    abandoned: the distance reports unrealisable targets.
    """
    forward = forward_map(Moments(9), sensor.wavelengths, sensor.matrix)
    hard = [[2e-4, 1e-3, 1e-5], [0.9, 0.0, 0.9], [1.2, -0.3, 0.5]]
    few = np.concatenate([TARGETS[:5], hard])
    many = np.resize(few, (CPU_ROWS[0] + len(few), 3))

    def solved(target):
        return solve(forward, np.zeros((len(target), 9)), target, 1e-8, max_passes)

    crowd = solved(many)
    alone = np.concatenate([solved(target[None]).multipliers for target in few])
    for rows in (crowd.multipliers[: len(few)], crowd.multipliers[-len(few) :]):
        assert_allclose(rows, alone, rtol=1e-9)
    assert crowd.distance[len(few) - 1] > 0.1


@pytest.fixture(scope="module")
def forward(sensor):
    return forward_map(MODEL, sensor.wavelengths, sensor.matrix)


def test_optimistix_runs_it(forward):
    with jax.enable_x64(True):
        found = optimistix.least_squares(
            lambda y, target: forward.residual(y, target),
            LeastChange(forward, 1e-9),
            PRIORS,
            args=INNER,
        )
    off = forward.residual(np.asarray(found.value), INNER)
    assert np.abs(off).max() <= 1e-9
    ours = solve(forward, PRIORS, INNER, tolerance=1e-9, max_passes=20, prior=PRIORS)
    assert_allclose(found.value, ours.multipliers, atol=1e-9)


def test_the_answer_is_the_nearest_to_the_prior_from_any_start(forward):
    """scipy minimises the distance from the prior under the constraint of
    the colour.
    """
    for start in (PRIORS, PRIORS + 0.05 * RNG.normal(size=PRIORS.shape)):
        found = solve(forward, start, INNER, 1e-12, max_passes=40, prior=PRIORS)
        for row, multipliers in enumerate(found.multipliers):
            oracle = minimize(
                lambda p, row=row: (
                    (forward.inverse_root @ (p - PRIORS[row])) ** 2
                ).sum(),
                PRIORS[row],
                method="SLSQP",
                tol=1e-14,
                constraints={
                    "type": "eq",
                    "fun": lambda p, row=row: forward.residual(p[None], INNER[[row]])[
                        0
                    ],
                },
            )
            assert_allclose(multipliers, oracle.x, atol=2e-4)
    without = solve(forward, start, INNER, 1e-12, max_passes=40)
    assert np.abs(without.multipliers - found.multipliers).max() > 1e-3


def test_stock_solvers_give_the_same_cube():
    """Nodes on the faces have nearly box-shaped spectra: there the default stops to
    pull towards the prior.
    """
    dogleg = optimistix.Dogleg(rtol=1e-8, atol=1e-8)
    spectra = []
    for solver, name in (
        ("least-change", "least-change"),
        ("gauss-newton", "gauss-newton"),
        (dogleg, CUSTOM),
    ):
        data = build(dim=4, coefficients=5, solver=solver).data
        assert data.provenance["options"]["solver"] == name
        assert data.points.distance.max() <= 1e-4
        coefficients = data.points.coefficients
        spectra.append(reflectance(MODEL, coefficients, data.sensor.wavelengths))
    default, *stock = spectra
    inner = ~np.isin(data.lattice.points, (0, 1)).any(axis=1)
    for other in stock:
        assert np.abs(other[inner] - default[inner]).max() <= 1e-5
        assert np.abs(other - default).max() <= 0.2
    assert np.abs(stock[0] - stock[1]).max() <= 1e-5


SEVERAL = """
import sys, jax, uplift
assert len(jax.devices()) == 3
uplift.build(sys.argv[1], dim=5).save(sys.argv[2])
"""


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_several_devices_build_the_same_cube(tmp_path):
    """Three simulated devices distribute the rows unevenly."""
    path = tmp_path / "several.uplift"
    flags = {"XLA_FLAGS": "--xla_force_host_platform_device_count=3"}
    run_python(SEVERAL, MACBETH, path, env=os.environ | flags)
    one, several = (cube.data.points for cube in (build(MACBETH, dim=5), load(path)))
    assert_allclose(several.coefficients, one.coefficients, rtol=0, atol=1e-9)
    assert_allclose(several.standard_error, one.standard_error, rtol=1e-6)
    assert_array_equal(several.status, one.status)
