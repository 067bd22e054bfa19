"""Other tools on the task of a build: CPU time per fitted node and accuracy, for docs/speed.md.

The task is the lattice of linear sRGB under D65, without an atlas. Answers are checked before they are timed. The other
tools must be installed: a record without them would replace one that has them.
"""

import json
import os
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from benchmarks import ROOT, record
from uplift.colorimetry import Sensor, observer
from uplift.common.arrays import Array
from uplift.common.processes import call_in_child
from uplift.lab.timing import TimingStats, time_calls, timing_stats
from uplift.lattice import Lattice, axis_nodes
from uplift.models import Moments, Sigmoid, evaluate, reflectance

THRESHOLD = 1e-4
"""Largest |linear RGB| between a fitted spectrum and its colour: the threshold of cubes."""
DIM = 16
OUR_DIMS = (16, 32)
OUR_MODELS = (("sigmoid", 3), ("moments", 3), ("moments", 5), ("moments", 9), ("moments", 17))
RUNS, LIMIT = 3, 3600
"""Runs, and seconds after which a tool counts as hung."""


@dataclass(frozen=True)
class Peer:
    """CPU time in µs per node (all threads) of a tool, share of nodes within `THRESHOLD`, and largest residual.

    ``model`` is 'sigmoid' or 'moments', ``count`` its number of coefficients.
    """

    tool: str
    model: str
    count: int
    points: int
    cpu_us: TimingStats
    share: float
    worst: float
    notes: str


def main() -> None:
    """Time each tool in a process without the compiled code or settings of the others, and store."""
    tools = (ceres, ours)  # what may be missing comes first
    ceres_rows, our_rows = (call_in_child(tool, RUNS, seconds=LIMIT) for tool in tools)
    record("peers", runs=RUNS, threshold=THRESHOLD, peers=[*our_rows, *ceres_rows])


@cache
def sensor() -> Sensor:
    """Return the sensor of the task: CIE 1931 observer, D65, linear sRGB."""
    return observer.sensor()


@cache
def lattice() -> Lattice:
    """Return the lattice of the other tools, with nodes spaced as sRGB."""
    return Lattice(axis_nodes("srgb", DIM))


def check_answers(rgb: ArrayLike, target: ArrayLike, *, least: float) -> dict[str, float]:
    """Compare linear RGB (n, 3) with ``target`` (n, 3): the share within `THRESHOLD`, and the largest residual.

    Raises `RuntimeError` if fewer than the share ``least`` come within `THRESHOLD`: some tools leave a few nodes
    unfitted, with more a time means nothing.
    """
    residual = np.abs(np.asarray(rgb) - np.asarray(target)).max(axis=1)
    residual = np.where(np.isfinite(residual), residual, np.inf)
    share = float((residual <= THRESHOLD).mean())
    if share < least:
        raise RuntimeError(f"wrong answer, not timed: {share:.1%} of the points are within {THRESHOLD:g}")
    return {"share": share, "worst": float(residual.max())}


def ours(runs: int) -> list[Peer]:
    """Time builds of every model at every dim, with smooth spectra as the prior."""
    import uplift

    rows = []
    for dim, (name, count) in product(OUR_DIMS, OUR_MODELS):
        build = partial(uplift.build, dim=dim, model=name, coefficients=count, prior="smooth")
        cube = build()  # compiles
        cpu = time_calls(build, runs)[1].scaled(1e6 / dim**3)
        spectra = reflectance(cube.data.model, cube.data.points.coefficients, sensor().wavelengths)
        answer = check_answers(sensor().rgb(spectra), cube.data.lattice.points, least=1.0)
        rows.append(Peer("uplift", name, count, dim**3, cpu, **answer, notes=f"{dim}³, compiled before"))
    return rows


CERES_SOURCE, CERES_BUILT = ROOT / "benchmarks" / "ceres", ROOT / "out" / "ceres"
CERES_NEEDS = "install Ceres, cmake and a C++ compiler: libceres-dev, cmake, g++"
CERES_STEPS = 12
"""Iterations from each start. The default of Ceres, 50, doubles the time for moments and fits no more of them."""
CERES_JOBS = (("sigmoid", 3, "sigmoid", 0.99), ("moments", 9, "moments", 0.5), ("moments", 9, "multipliers", 0.99))
"""Model, coefficients, unknowns, and the minimum share of nodes that must be fitted."""
UNKNOWNS = {"sigmoid": "", "moments": "in c, ", "multipliers": "in p, "}


def ceres(runs: int) -> list[Peer]:
    """Time the solver of the thesis with numeric differences (`benchmarks/ceres/fit.cpp`).

    It grows from the middle of the lattice, every node from its fitted neighbours.
    """
    program = _build_ceres()
    return [_ceres_row(program, *job, runs) for job in CERES_JOBS]


def _build_ceres() -> Path:
    """Build the program. Raises `RuntimeError` without cmake, a compiler or Ceres."""
    try:
        for words in (["-S", CERES_SOURCE, "-B", CERES_BUILT], ["--build", CERES_BUILT]):
            subprocess.run(["cmake", *words], capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise RuntimeError(CERES_NEEDS) from error
    return CERES_BUILT / "fit"


def _ceres_row(program: Path, name: str, count: int, unknowns: str, least: float, runs: int) -> Peer:
    model, points = Sigmoid() if name == "sigmoid" else Moments(count), lattice().points
    done = [_run_ceres(program, unknowns, count) for _ in range(runs)]
    solution, facts = done[-1]
    multipliers = model.from_storage(solution) if unknowns == "moments" else solution
    answer = check_answers(sensor().rgb(evaluate(model, multipliers, sensor().wavelengths)), points, least=least)
    cpu = timing_stats([each["cpu"] for _, each in done]).scaled(1e6 / len(points))
    starts = facts["solves"] / len(points)
    notes = f"{DIM}³, {UNKNOWNS[unknowns]}numeric differences, C++; grown from the middle, {starts:.1f} starts a point"
    return Peer(f"Ceres {facts['ceres']}", name, count, len(points), cpu, **answer, notes=notes)


def _run_ceres(program: Path, unknowns: str, count: int) -> tuple[Array, dict[str, Any]]:
    """Return the solutions (n, count), and the statistics printed by the program."""
    numbers = np.concatenate([sensor().wavelengths, sensor().matrix.ravel(), lattice().nodes])
    text = f"{len(sensor().wavelengths)} {DIM}\n" + "\n".join(map(repr, numbers.tolist())) + "\n"
    with tempfile.TemporaryDirectory() as folder:
        scene, solution = Path(folder, "scene.txt"), Path(folder, "found")
        scene.write_text(text)
        command = [str(program), str(scene), str(solution), unknowns, str(count), str(CERES_STEPS)]
        # Ceres logs every step outside the moments of reflectances, which would be timed too.
        quiet = os.environ | {"GLOG_minloglevel": "3"}
        done = subprocess.run(command, env=quiet, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        return np.fromfile(solution).reshape(-1, count), json.loads(done.stdout)
