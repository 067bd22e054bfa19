"""Any solver of optimistix gives the cube of the step of least change."""

from __future__ import annotations

import numpy as np
import optimistix

from tests.helpers import raises
from uplift import build
from uplift.colorimetry.lights import SCENE_LIGHTS
from uplift.colorimetry.observer import light
from uplift.common.errors import UpliftError
from uplift.fit.entries import fit_entries
from uplift.fit.objective import BALANCED, objective
from uplift.fit.stock_solver import STOCK, StockSolver, solve_objective
from uplift.models import Moments, evaluate
from uplift.models.minimum_norm import forward_map
from uplift.pipeline.options import CUSTOM, SOLVERS

MODEL = Moments(5)
SMALL = {"dim": 4, "coefficients": 5, "entry_coefficients": 5}


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
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    lights = [light(name) for name in SCENE_LIGHTS]
    ours, theirs = (
        fit_entries(MODEL, forward, measured, sensor.rgb(measured), lights, light("A"), 1e-8, solver=solver)
        for solver in (None, STOCK["levenberg-marquardt"](1e-8))
    )
    spectra = [evaluate(MODEL, each.multipliers, sensor.wavelengths) for each in (ours, theirs)]
    np.testing.assert_allclose(*spectra, atol=1e-4)
    np.testing.assert_allclose(theirs.error, ours.error, atol=1e-4)


def test_no_distance_increases(sensor):
    """A solver that may take one step only."""
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    start, target = np.zeros((4, 5)), np.full((4, 3), 0.5)
    solver = StockSolver(STOCK["gauss-newton"](1e-8))
    found = solver(MODEL, forward, start, target, tolerance=1e-8, max_passes=1)
    np.testing.assert_allclose(found.multipliers, start, atol=1e-12)
    assert found.distance.max() <= 1e-8


def test_a_solver_that_stops_early_is_an_error(sensor):
    measured = 0.5 + 0.4 * np.sin(sensor.wavelengths / 60)[None]
    goal = objective(MODEL, MODEL.basis(sensor.wavelengths), [light("A")], BALANCED)
    lazy = optimistix.GaussNewton(rtol=10.0, atol=10.0)
    with raises(UpliftError, "solver-failed"):
        solve_objective(lazy, goal, measured)


def test_every_name_has_a_solver():
    assert set(SOLVERS) == {"least-change", *STOCK}
