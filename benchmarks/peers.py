"""The solver of the thesis on the task of a build: CPU time per fitted node and
accuracy, for docs/speed.md.

The task is the lattice of linear sRGB under D65, without an atlas.
"""

import json
import subprocess
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ROOT, Row
from benchmarks.programs import output
from benchmarks.timing import time_call
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.timing import timing_stats
from uplift.lab.study.sensitivity import node_spectra
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.models.model import evaluate
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

THRESHOLD = 1e-4
"""Largest |linear RGB| between a fitted spectrum and its colour: the threshold of
cubes.
"""
DIM = 16
SENSOR = observer.sensor()
LATTICE = Lattice(axis_nodes("srgb", DIM))
"""Nodes of both, spaced as sRGB."""
MODELS = (("sigmoid", 3), ("moments", 9))
RUNS = 3
SOURCE = ROOT / "benchmarks" / "ceres"
BUILT = ROOT / "out" / "ceres"
JOBS = (
    ("sigmoid", 3, "sigmoid", 0.99),
    ("moments", 9, "moments", 0.5),
    ("moments", 9, "multipliers", 0.99),
)
"""Model, coefficients, unknowns, and the minimum share of nodes that must be fitted."""


def check_share(rgb: Array, target: Array, *, least: float) -> float:
    """Return the share of linear RGB (n, 3) within `THRESHOLD` of ``target`` (n, 3).

    Raises `RuntimeError` if fewer than the share ``least`` come within `THRESHOLD`:
    some tools leave a few nodes unfitted, with more a time means nothing.
    """
    residual = np.abs(rgb - target).max(axis=1)
    share = (residual <= THRESHOLD).mean()
    if share < least:
        raise RuntimeError(
            f"wrong answer, not timed: {share:.1%} of the nodes are within "
            f"{THRESHOLD:g}"
        )
    return share


def ours() -> Iterator[Row]:
    """Yield our builds, with smooth spectra as the prior."""
    for name, count in MODELS:
        build = partial(
            uplift.build, dim=DIM, model=name, coefficients=count, prior="smooth"
        )
        data = build().data  # compiles
        spectra = node_spectra(data)
        yield {
            "tool": "uplift",
            "model": name,
            "count": count,
            "share": check_share(SENSOR.rgb(spectra), data.lattice.points, least=1.0),
            "cpu_us": time_call(build, RUNS).cpu.scaled(1e6 / DIM**3),
            "notes": "compiled before",
        }


def ceres() -> Iterator[Row]:
    """Yield Ceres with numeric differences (`benchmarks/ceres/fit.cpp`), which needs
    libceres-dev, cmake and g++.

    It grows from the middle of the lattice, every node from its fitted neighbours.
    """
    subprocess.run(["cmake", "-S", SOURCE, "-B", BUILT], check=True)
    subprocess.run(["cmake", "--build", BUILT], check=True)
    points = LATTICE.points
    for name, count, unknowns, least in JOBS:
        runs = [run_ceres(unknowns, count) for _ in range(RUNS)]
        solution, facts = runs[-1]
        model = Sigmoid() if name == "sigmoid" else Moments(count)
        if unknowns == "moments":
            solution = model.from_storage(solution)
        spectra = evaluate(model, solution, SENSOR.wavelengths)
        cpu = timing_stats([figures["cpu"] for _, figures in runs])
        starts = facts["solves"] / len(points)
        yield {
            "tool": f"Ceres {facts['ceres']}",
            "model": name,
            "count": count,
            "share": check_share(SENSOR.rgb(spectra), points, least=least),
            "cpu_us": cpu.scaled(1e6 / len(points)),
            "notes": f"unknowns: {unknowns}; {starts:.1f} starts a point",
        }


def run_ceres(unknowns: str, count: int) -> tuple[Array, Row]:
    """Return the solutions (n, count), and the statistics printed by the program."""
    scene = [SENSOR.wavelengths, SENSOR.matrix.ravel(), LATTICE.nodes]
    lines = [f"{len(SENSOR.wavelengths)} {DIM}"]
    lines += map(repr, np.concatenate(scene).tolist())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.txt").write_text("\n".join([*lines, ""]))
        # 12 iterations from each start: more, as by default, fit no more moments. Ceres
        # logs every step outside the moments of reflectances, which would be timed too.
        quiet = ("env", "GLOG_minloglevel=3", BUILT / "fit")
        options = ("scene.txt", "found", unknowns, str(count), "12")
        printed = output(*quiet, *options, folder=folder)
        return np.fromfile(folder / "found").reshape(-1, count), json.loads(printed)


QUESTIONS = {"ours": ours, "ceres": ceres}
