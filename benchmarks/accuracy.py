"""Round trips, ranges, starts and solvers of cubes, for docs/accuracy.md."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np

import uplift
from benchmarks import MACBETH, record
from benchmarks.materials import errors, materials
from uplift.atlas import on_grid
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.chart.method import at_1_nm
from uplift.lab.timing import time_calls
from uplift.lattice import Status
from uplift.lookup import MODES, Cube
from uplift.models import reflectance

RANGES = (
    (380, 780, 10),
    (380, 780, 5),
    (380, 780, 1),
    (360, 830, 10),
    (360, 830, 5),
    (360, 830, 1),
    (360, 1000, 5),
)
"""First and last wavelength and step in nm."""
VISIBLE = np.arange(400, 701, 5)
DIMS = (16, 32, 64)
QUERIES = np.random.default_rng(20000).random((20000, 3))
START_DIM, SOLVER_DIM, RUNS = 32, 8, 3
SPACES = ("sRGB", "ITU-R BT.2020", "ProPhoto RGB")
OTHERS = ("rawtoaces", "cie2017")
"""Materials that a cube of the ColorChecker answers for."""
SOLVERS = ("least-change", "gauss-newton", "dogleg", "levenberg-marquardt")
Row = dict[str, Any]


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    fitted, round_trips = [], []
    for name, cube in cubes():
        fitted.append({"cube": name, **fit_quality(cube)})
        fine = at_1_nm(cube.data.sensor)
        round_trips.append(
            {
                "cube": name,
                "errors": {mode: round_trip(cube, cube.data.sensor, mode) for mode in MODES},
                "fine": {mode: round_trip(cube, fine, mode) for mode in MODES},
            }
        )
    ranges = [at_range(*each) for each in RANGES]
    record("accuracy", queries=len(QUERIES), fitted=fitted, round_trips=round_trips, ranges=ranges)
    record(
        "accuracy",
        "growth",
        runs=RUNS,
        starts=[start(name, space) for space in SPACES for name in ("outward", "coarse-to-fine", "neighbours")],
        solvers=[solver(name) for name in SOLVERS],
        start_dim=START_DIM,
        solver_dim=SOLVER_DIM,
        materials=[{"name": name, "count": len(materials(name).rgb)} for name in OTHERS],
    )


def cubes() -> Iterator[tuple[str, Cube]]:
    """Build the cubes, with their names."""
    build = partial(uplift.build, debug=True)
    for dim, model, atlas in product(DIMS, ("moments", "sigmoid"), (MACBETH, None)):
        yield f"{model}, {'Macbeth' if atlas else 'no atlas'}, {dim}³", build(atlas, dim=dim, model=model)
    for count in (3, 17):
        yield f"{count} coefficients, Macbeth, 32³", build(MACBETH, dim=32, coefficients=count)


def fit_quality(cube: Cube) -> Row:
    """Return the rounds of growth, counts of nodes and the largest residual."""
    data = cube.data.points
    rounds = int(data.round.max()) + 1 if data.round is not None else 0
    return {
        "rounds": rounds,
        **{key: data.counts()[key] for key in ("improved", "unfitted")},
        "worst": data.distance.max(),
    }


def round_trip(cube: Cube, sensor: Sensor, mode: str = "spectra") -> list[float]:
    """Return the mean and the largest ΔE00 between the requested colours and those of the spectra, for a judge."""
    found = delta_e_rgb(sensor, QUERIES, sensor.rgb(cube.reflectance(QUERIES, sensor.wavelengths, mode)))
    return [float(found.mean()), float(found.max())]


def at_range(shortest: int, longest: int, step: int) -> Row:
    """Build the ColorChecker at a range; return errors at 1 nm, and those of the spectra of its entries."""
    cube, atlas = uplift.build(MACBETH, shortest=shortest, longest=longest, step=step), uplift.read_atlas(MACBETH)
    measured = dict(zip(atlas.names, on_grid(atlas, VISIBLE), strict=True))
    off = cube.reflectance(cube.data.atlas.rgb, VISIBLE) - [measured[name] for name in cube.data.atlas.names]
    fine = round_trip(cube, at_1_nm(cube.data.sensor))
    rms = float(np.sqrt((off**2).mean()))
    return {"range": f"{shortest}–{longest} nm", "step": step, "fine": fine, "rms": rms}


def start(name: str, space: str) -> Row:
    """Build with a start, and compare answers for materials that neither atlas nor library contains."""
    build = partial(uplift.build, MACBETH, dim=START_DIM, growth=name, space=space, leave_out=OTHERS, debug=True)
    cube = build()
    _, seconds = time_calls(build, RUNS)
    answers = {}
    if space == SPACES[0]:
        answers = {each: errors(cube.reflectance(materials(each).rgb), materials(each)) for each in OTHERS}
    status = cube.data.points.status
    return {
        "start": name,
        "space": space,
        "seconds": seconds,
        "rounds": fit_quality(cube)["rounds"],
        "unfitted": int((status == Status.UNFITTED).sum()),
        "unrealisable": int((status == Status.UNREALISABLE).sum()),
        "answers": answers,
    }


def solver(name: str) -> Row:
    """Build a small cube with a solver, and compare it with the default."""
    build = partial(uplift.build, MACBETH, dim=SOLVER_DIM, solver=name)
    _, first = time_calls(build, 1)
    default, cube = uplift.build(MACBETH, dim=SOLVER_DIM), build()
    _, seconds = time_calls(build, RUNS)
    difference = np.abs(node_spectra(cube) - node_spectra(default)).max(axis=1)
    inner = ~np.isin(cube.data.lattice.points, (0, 1)).any(axis=1)
    return {
        "solver": name,
        "first": first.median,
        "seconds": seconds,
        "unfitted": cube.data.points.counts()["unfitted"],
        "inner": difference[inner].max(),
        "faces": difference[~inner].max(),
    }


def node_spectra(cube: Cube) -> Array:
    """Return the reflectances (n, N) of the nodes."""
    return reflectance(cube.data.model, cube.data.points.coefficients, cube.data.sensor.wavelengths)


if __name__ == "__main__":
    main()
