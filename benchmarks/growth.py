"""Orders of growth, starts and solvers compared: writes docs/data/growth.json.

Every build is checked before it is timed. Times are CPU seconds of builds in this process, after compilation.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np

import uplift
from benchmarks.fidelity.materials import errors, materials
from benchmarks.record import ROOT, write
from uplift.common.arrays import Array
from uplift.fit.growth import Growth, strides
from uplift.lab.timing import spread
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.models import evaluate

MACBETH = ROOT / "atlases" / "macbeth.txt"
DIMS = (32, 64)
START_DIM, SOLVER_DIM = 32, 8
RUNS = 3
OTHERS = ("rawtoaces", "cie2017")
"""Materials that a cube of the ColorChecker answers for."""
ORDERS: dict[str, Callable[[int], list[int]]] = {
    "all at once, from the prior alone": lambda dim: [1],
    "every second node first": lambda dim: [2, 1],
    "from coarse to fine, the default": strides,
}
SPACES = ("sRGB", "ITU-R BT.2020", "ProPhoto RGB")


def main() -> None:
    """Measure and store."""
    write(
        "growth",
        "python -m benchmarks.growth",
        runs=RUNS,
        orders=[order(name, dim) for dim in DIMS for name in ORDERS],
        starts=[start(name, space) for space in SPACES for name in ("prior", "neighbours")],
        solvers=[solver(name) for name in ("least-change", "gauss-newton", "dogleg", "levenberg-marquardt")],
        start_dim=START_DIM,
        solver_dim=SOLVER_DIM,
        materials=[{"name": name, "count": len(materials(name).rgb)} for name in OTHERS],
    )


def order(name: str, dim: int) -> dict[str, Any]:
    """Compare an order of growth with the answers of the default."""
    default, _ = _build(dim)
    with patch("uplift.fit.growth.strides", ORDERS[name]):
        cube, growth = _build(dim)
        seconds = _seconds(lambda: _build(dim), RUNS)
    difference = np.abs(_node_spectra(cube) - _node_spectra(default)).max(axis=1)
    return {
        "order": name,
        "dim": dim,
        "rounds": int(growth.round.max()) + 1,
        "steps": growth.steps / dim**3,
        "microseconds": {key: value / dim**3 * 1e6 for key, value in seconds.items()},
        "median_difference": float(np.median(difference)),
        "largest_999": float(np.quantile(difference, 0.999)),
    }


def start(name: str, space: str) -> dict[str, Any]:
    """Build with a start, and compare answers for materials that neither atlas nor library contains."""
    cube, growth = _build(START_DIM, start=name, space=space, leave_out=OTHERS)
    status = cube.data.points.status
    seconds = _seconds(lambda: _build(START_DIM, start=name, space=space, leave_out=OTHERS), RUNS)
    answers = {each: _errors(cube, each) for each in OTHERS} if space == "sRGB" else {}
    return {
        "start": name,
        "space": space,
        "seconds": seconds,
        "rounds": int(growth.round.max()) + 1,
        "steps": growth.steps / START_DIM**3,
        "unfitted": int((status == Status.UNFITTED).sum()),
        "unrealisable": int((status == Status.UNREALISABLE).sum()),
        "answers": answers,
    }


def solver(name: str) -> dict[str, Any]:
    """Build a small cube with a solver, and compare it with the default."""
    cold = _seconds(lambda: _build(SOLVER_DIM, solver=name), 1)
    default, _ = _build(SOLVER_DIM)
    cube, growth = _build(SOLVER_DIM, solver=name)
    seconds = _seconds(lambda: _build(SOLVER_DIM, solver=name), RUNS)
    difference = np.abs(_node_spectra(cube) - _node_spectra(default)).max(axis=1)
    inner = ~np.isin(cube.data.lattice.points, (0, 1)).any(axis=1)
    return {
        "solver": name,
        "first": cold["median"],
        "seconds": seconds,
        "steps": growth.steps / SOLVER_DIM**3,
        "unfitted": int((cube.data.points.status == Status.UNFITTED).sum()),
        "inner": float(difference[inner].max()),
        "faces": float(difference[~inner].max()),
    }


@contextmanager
def _watched() -> Iterator[list[Growth]]:
    """Collect the states of growth of the builds within."""
    states: list[Growth] = []
    original = Growth.__post_init__

    def note(growth: Growth) -> None:
        original(growth)
        states.append(growth)

    with patch.object(Growth, "__post_init__", note):
        yield states


def _build(dim: int, **options: Any) -> tuple[Cube, Growth]:
    with warnings.catch_warnings(), _watched() as states:
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        cube = uplift.build(MACBETH, dim=dim, **options)
    return cube, states[-1]


def _seconds(action: Callable[[], object], runs: int) -> dict[str, float]:
    laps: list[float] = []
    for _ in range(runs):
        begin = time.process_time()
        action()
        laps.append(time.process_time() - begin)
    return _as_record(laps)


def _as_record(laps: Sequence[float]) -> dict[str, float]:
    found = spread(laps)
    return {"median": found.median, "min": found.min, "max": found.max}


def _node_spectra(cube: Cube) -> Array:
    data = cube.data
    return evaluate(data.model, data.model.from_storage(data.points.coefficients), data.sensor.wavelengths)


def _errors(cube: Cube, name: str) -> dict[str, Any]:
    some = materials(name)
    return errors(cube.reflectance(some.rgb, cube.data.sensor.wavelengths), some)


if __name__ == "__main__":
    main()
