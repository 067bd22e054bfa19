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

from tests.helpers import run_python
from uplift import build, load
from uplift.fit.batch import CPU_ROWS, map_batches
from uplift.fit.solver import LeastChange, solve
from uplift.models.minimum_norm import forward_map
from uplift.models.model import evaluate
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.options import CUSTOM

RNG = np.random.default_rng(2)
TARGETS = RNG.uniform(0.05, 0.95, (40, 3))
MODEL = Moments(5)
INNER = RNG.uniform(0.2, 0.8, (6, 3))
PRIORS = RNG.normal(size=(6, 5)) / 5
SMALL = {"dim": 4, "coefficients": 5, "entry_coefficients": 5}


@pytest.mark.parametrize("model", [Moments(9), Sigmoid()], ids=["moments", "sigmoid"])
def test_distances_are_at_most_those_of_scipy(model, sensor):
    """With as many unknowns as equations the solution is unique."""
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    found = solve(
        forward, np.zeros((40, model.count)), TARGETS, tolerance=1e-9, max_passes=40
    )
    for target, multipliers, distance in zip(
        TARGETS, found.multipliers, found.distance, strict=True
    ):
        oracle = least_squares(
            lambda p, target=target: forward.residual(p[None], target[None])[0],
            np.zeros(model.count),
            xtol=1e-15,
        )
        assert distance <= 1e-9 or distance <= np.abs(oracle.fun).max() * 1.01
        if model.count == 3 and np.abs(oracle.fun).max() <= 1e-9:
            assert_allclose(multipliers, oracle.x, rtol=1e-4, atol=1e-5)


def test_no_distance_increases(sensor):
    """Unrealisable targets are not an error: the distance reports them."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    wild = RNG.uniform(-1, 2, (50, 3))
    start = RNG.normal(size=(50, 9))
    before = (forward.residual(start, wild) ** 2).sum(axis=1)
    found = solve(forward, start, wild, tolerance=1e-6, max_passes=3)
    after = (forward.residual(found.multipliers, wild) ** 2).sum(axis=1)
    assert (after <= before * (1 + 1e-12)).all()
    assert np.isfinite(found.multipliers).all()
    assert (found.distance > 1e-6).any()


@pytest.mark.parametrize("max_passes", [1, 12])
def test_solutions_do_not_depend_on_the_batch(sensor, max_passes):
    """A problem has the same solution alone and among many, also if it is hard or
    abandoned.
    """
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    dark = [[2e-4, 1e-3, 1e-5]]
    wild = [[0.9, 0.0, 0.9], [1.2, -0.3, 0.5]]
    few = np.concatenate([TARGETS[:5], dark, wild])
    many = np.resize(few, (CPU_ROWS[0] + len(few), 3))
    crowd = solve(
        forward, np.zeros((len(many), 9)), many, tolerance=1e-8, max_passes=max_passes
    )
    for row, target in enumerate(few):
        alone = solve(
            forward,
            np.zeros((1, 9)),
            target[None],
            tolerance=1e-8,
            max_passes=max_passes,
        )
        for found in (row, row + len(many) - len(few)):
            assert_allclose(crowd.multipliers[found], alone.multipliers[0], rtol=1e-9)


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


def test_the_answer_is_the_nearest_to_the_prior(forward):
    """scipy minimises the distance from the prior under the constraint of
    the colour.
    """
    found = solve(forward, PRIORS, INNER, tolerance=1e-12, max_passes=40, prior=PRIORS)
    for prior, target, multipliers in zip(
        PRIORS, INNER, found.multipliers, strict=True
    ):
        oracle = minimize(
            lambda p, prior=prior: ((forward.inverse_root @ (p - prior)) ** 2).sum(),
            prior,
            method="SLSQP",
            tol=1e-14,
            constraints={
                "type": "eq",
                "fun": lambda p, target=target: forward.residual(p[None], target[None])[
                    0
                ],
            },
        )
        assert_allclose(multipliers, oracle.x, atol=2e-4)


def test_the_answer_does_not_depend_on_the_start(forward):
    starts = PRIORS + 0.05 * RNG.normal(size=PRIORS.shape)
    one, other = (
        solve(forward, start, INNER, tolerance=1e-12, max_passes=40, prior=PRIORS)
        for start in (PRIORS, starts)
    )
    assert_allclose(one.multipliers, other.multipliers, atol=1e-5)
    without = solve(forward, starts, INNER, tolerance=1e-12, max_passes=40)
    assert np.abs(without.multipliers - one.multipliers).max() > 1e-3


def test_stock_solvers_give_the_same_cube():
    """Nodes on the faces have nearly box-shaped spectra: there the default stops to
    pull towards the prior.
    """
    dogleg = optimistix.Dogleg(rtol=1e-8, atol=1e-8)
    cubes = [
        build(**SMALL, solver=solver)
        for solver in ("least-change", "gauss-newton", dogleg)
    ]
    assert [cube.data.provenance["options"]["solver"] for cube in cubes[1:]] == [
        "gauss-newton",
        CUSTOM,
    ]
    sensor = cubes[0].data.sensor
    nodes = cubes[0].data.lattice.points
    default, *stock = (
        evaluate(
            MODEL, MODEL.from_storage(cube.data.points.coefficients), sensor.wavelengths
        )
        for cube in cubes
    )
    inner = ~np.isin(nodes, (0, 1)).any(axis=1)
    for spectra in stock:
        assert np.abs(spectra[inner] - default[inner]).max() <= 1e-5
        assert np.abs(spectra - default).max() <= 0.2
    assert np.abs(stock[0] - stock[1]).max() <= 1e-5
    assert max(cube.data.points.distance.max() for cube in cubes) <= 1e-4


def test_every_step_of_the_lattice_goes_through_the_interface_of_optimistix(
    monkeypatch,
):
    """Without steps no node is fitted but those that start at their colour."""
    stepped = build(**SMALL).data
    monkeypatch.setattr(
        LeastChange,
        "step",
        lambda self, fn, y, args, options, state, tags: (y, state, None),
    )
    jax.clear_caches()
    still = build(**SMALL).data
    jax.clear_caches()
    assert (stepped.points.distance <= 1e-4).all()
    assert (still.points.distance > 1e-4).mean() > 0.9


def squares(constants, rows):
    return constants * rows["x"] ** 2, rows["x"][:, 0]


@pytest.mark.parametrize("count", [1, CPU_ROWS[1] + 1, 2 * CPU_ROWS[0] + 3])
def test_every_row_is_in_one_batch(count):
    x = RNG.random((count, 2))
    found, first = map_batches(squares, np.array(3.0), {"x": x})
    assert_allclose(found, 3 * x**2, rtol=1e-15)
    assert_array_equal(first, x[:, 0])


SEVERAL = """
import sys, jax, uplift
assert len(jax.devices()) == 3
uplift.build(sys.argv[1], dim=5).save(sys.argv[2])
"""


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_several_devices_build_the_same_cube(repository, tmp_path):
    """Three simulated devices distribute the rows unevenly."""
    macbeth = repository / "atlases" / "macbeth.txt"
    path = tmp_path / "several.uplift"
    flags = {"XLA_FLAGS": "--xla_force_host_platform_device_count=3"}
    run_python(SEVERAL, macbeth, path, env=os.environ | flags)
    one = build(macbeth, dim=5).data
    several = load(path).data
    assert_allclose(
        several.points.coefficients, one.points.coefficients, rtol=0, atol=1e-9
    )
    assert_allclose(several.points.standard_error, one.points.standard_error, rtol=1e-6)
    assert_array_equal(several.points.status, one.points.status)
