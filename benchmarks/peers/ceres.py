"""The solver of the thesis: Ceres with numeric differences (`benchmarks/ceres/fit.cpp`), built if it is installed."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge_multipliers, missing, model_of
from benchmarks.record import ROOT
from uplift.common.arrays import Array
from uplift.lab.timing import spread

SOURCE, BUILT = ROOT / "benchmarks" / "ceres", ROOT / "out" / "ceres"
NEEDS = "Ceres with cmake and a C++ compiler (libceres-dev, cmake, g++)"
STEPS = 12
"""Iterations from each start. The default of Ceres, 50, doubles the time for moments and fits no more of them."""

JOBS = (("sigmoid", 3, "sigmoid", 0.99), ("moments", 9, "moments", 0.5), ("moments", 9, "multipliers", 0.99))
"""Model, coefficients, unknowns, and the minimum share of nodes that must be fitted."""
IN = {"sigmoid": "", "moments": "in c, ", "multipliers": "in p, "}
QUIET = {"GLOG_minloglevel": "3"}
"""Ceres logs every step outside the moments of reflectances, which would be timed too."""


def ceres(runs: int) -> list[Peer]:
    """Time Ceres, growing from the middle of the lattice, every node from its fitted neighbours."""
    program = _build()
    if program is None:
        return [missing("Ceres", NEEDS, model, count) for model, count, *_ in JOBS]
    return [_row(program, *job, runs) for job in JOBS]


def _build() -> Path | None:
    """Build the program; return None if cmake, a compiler or Ceres is missing."""
    program = BUILT / "fit"
    if shutil.which("cmake") is None or _cmake("-S", str(SOURCE), "-B", str(BUILT)).returncode:
        return None
    program.unlink(missing_ok=True)  # of an earlier build
    _cmake("--build", str(BUILT)).check_returncode()
    return program if program.exists() else None


def _cmake(*words: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(["cmake", *words], capture_output=True, check=False)


def _row(program: Path, name: str, count: int, unknowns: str, least: float, runs: int) -> Peer:
    model, points = model_of(name, count), task.lattice().points
    done = [_run(program, unknowns, count) for _ in range(runs)]
    solution, facts = done[-1]
    multipliers = model.from_storage(solution) if unknowns == "moments" else solution
    answer = judge_multipliers(model, multipliers, task.sensor(), points, least=least)
    cpu = spread([each["cpu"] for _, each in done]).scaled(1e6 / len(points))
    starts = facts["solves"] / len(points)
    notes = f"{task.DIM}³, {IN[unknowns]}numeric differences, C++; grown from the middle, {starts:.1f} starts a point"
    return Peer(f"Ceres {facts['ceres']}", name, count, len(points), cpu, answer, notes)


def _run(program: Path, unknowns: str, count: int) -> tuple[Array, dict[str, Any]]:
    """Return the solutions (n, count), and the statistics printed by the program."""
    with tempfile.TemporaryDirectory() as folder:
        scene, solution = Path(folder, "scene.txt"), Path(folder, "found")
        scene.write_text(_scene())
        command = [str(program), str(scene), str(solution), unknowns, str(count), str(STEPS)]
        statistics = subprocess.run(
            command, env=os.environ | QUIET, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True
        ).stdout
        return np.fromfile(solution).reshape(-1, count), json.loads(statistics)


def _scene() -> str:
    """Input of the program: sizes, wavelengths, sensor matrix, axis nodes."""
    sensor, nodes = task.sensor(), task.lattice().nodes
    numbers = np.concatenate([sensor.wavelengths, sensor.matrix.ravel(), nodes])
    return f"{len(sensor.wavelengths)} {len(nodes)}\n" + "\n".join(map(repr, numbers.tolist())) + "\n"
