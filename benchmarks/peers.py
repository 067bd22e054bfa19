"""Other tools on the task of a build: CPU time per fitted node and accuracy, for
docs/speed.md.

The task is the lattice of linear sRGB under D65, without an atlas. Answers are checked
before they are timed. The other tools must be installed: a record without them would
replace one that has them.
"""

import json
import os
import subprocess
import tempfile
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks import ROOT, Row, record
from uplift.colorimetry import Sensor, observer
from uplift.common.arrays import Array
from uplift.extras.images.processes import call_in_child
from uplift.lab.methods.mitsuba3 import XYZ_TO_RGB
from uplift.lab.timing import TimingStats, children_cpu, time_calls, timing_stats
from uplift.lattice import Lattice, axis_nodes
from uplift.models import Moments, Sigmoid, evaluate, reflectance
from uplift.models.sigmoid import evaluate_unscaled

THRESHOLD = 1e-4
"""Largest |linear RGB| between a fitted spectrum and its colour: the threshold of
cubes.
"""
DIM = 16
SENSOR = observer.sensor()
LATTICE = Lattice(axis_nodes("srgb", DIM))
"""Nodes of Ceres, spaced as sRGB."""
OUR_MODELS = (
    ("sigmoid", 3),
    ("moments", 3),
    ("moments", 5),
    ("moments", 9),
    ("moments", 17),
)
OUR_BUILDS = (
    *product((16, 32), OUR_MODELS),
    (64, ("sigmoid", 3)),
    (64, ("moments", 9)),
)
"""Dim, model and coefficients."""
RUNS = 3
LIMIT = 3600
"""Seconds after which a tool counts as hung."""


@dataclass(frozen=True)
class Peer:
    """CPU time of a tool in µs per node, of all threads, and its accuracy.

    ``model`` is 'sigmoid' or 'moments', ``count`` its number of coefficients. ``share``
    of the nodes are within `THRESHOLD`, and ``worst`` is the largest residual.
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
    """Time each tool in its own process and store."""
    tools = (ceres, rgb2spec, ours)  # what may be missing comes first
    solvers, tables, builds = (
        call_in_child(tool, RUNS, seconds=LIMIT) for tool in tools
    )
    record("peers", runs=RUNS, threshold=THRESHOLD, peers=[*builds, *solvers, *tables])


def check_answers(rgb: Array, target: Array, *, least: float) -> dict[str, float]:
    """Return the share of linear RGB (n, 3) within `THRESHOLD` of ``target`` (n, 3),
    and the largest residual.

    Raises `RuntimeError` if fewer than the share ``least`` come within `THRESHOLD`:
    some tools leave a few nodes unfitted, with more a time means nothing.
    """
    residual = np.abs(rgb - target).max(axis=1)
    residual[np.isnan(residual)] = np.inf
    share = (residual <= THRESHOLD).mean()
    if share < least:
        raise RuntimeError(
            f"wrong answer, not timed: {share:.1%} of the nodes are within "
            f"{THRESHOLD:g}"
        )
    return {"share": share, "worst": residual.max()}


def _install(needs: str, *commands: list[str | Path]) -> None:
    """Run commands that compile a tool. Raises `RuntimeError` with what it needs."""
    try:
        for command in commands:
            subprocess.run(command, capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise RuntimeError(needs) from error


def ours(runs: int) -> list[Peer]:
    """Time `OUR_BUILDS`, with smooth spectra as the prior."""
    import uplift

    rows = []
    for dim, (name, count) in OUR_BUILDS:
        build = partial(
            uplift.build, dim=dim, model=name, coefficients=count, prior="smooth"
        )
        data = build().data  # compiles
        cpu = time_calls(build, runs)[1].scaled(1e6 / dim**3)
        spectra = reflectance(data.model, data.points.coefficients, SENSOR.wavelengths)
        answer = check_answers(SENSOR.rgb(spectra), data.lattice.points, least=1.0)
        notes = f"{dim}³, compiled before"
        rows.append(Peer("uplift", name, count, dim**3, cpu, **answer, notes=notes))
    return rows


CERES_SOURCE = ROOT / "benchmarks" / "ceres"
CERES_BUILT = ROOT / "out" / "ceres"
CERES_JOBS = (
    ("sigmoid", 3, "sigmoid", 0.99),
    ("moments", 9, "moments", 0.5),
    ("moments", 9, "multipliers", 0.99),
)
"""Model, coefficients, unknowns, and the minimum share of nodes that must be fitted."""
UNKNOWNS = {"sigmoid": "", "moments": "in c, ", "multipliers": "in p, "}


def ceres(runs: int) -> list[Peer]:
    """Time the solver of the thesis with numeric differences
    (`benchmarks/ceres/fit.cpp`).

    It grows from the middle of the lattice, every node from its fitted neighbours.
    """
    _install(
        "install Ceres, cmake and a C++ compiler: libceres-dev, cmake, g++",
        ["cmake", "-S", CERES_SOURCE, "-B", CERES_BUILT],
        ["cmake", "--build", CERES_BUILT],
    )
    return [_ceres_row(CERES_BUILT / "fit", *job, runs) for job in CERES_JOBS]


def _ceres_row(
    program: Path, name: str, count: int, unknowns: str, least: float, runs: int
) -> Peer:
    model = Sigmoid() if name == "sigmoid" else Moments(count)
    points = LATTICE.points
    seconds = []
    for _ in range(runs):
        solution, facts = _run_ceres(program, unknowns, count)
        seconds.append(facts["cpu"])
    multipliers = model.from_storage(solution) if unknowns == "moments" else solution
    spectra = evaluate(model, multipliers, SENSOR.wavelengths)
    answer = check_answers(SENSOR.rgb(spectra), points, least=least)
    cpu = timing_stats(seconds).scaled(1e6 / len(points))
    starts = facts["solves"] / len(points)
    notes = (
        f"{DIM}³, {UNKNOWNS[unknowns]}numeric differences, C++; grown from the "
        f"middle, {starts:.1f} starts a point"
    )
    tool = f"Ceres {facts['ceres']}"
    return Peer(tool, name, count, len(points), cpu, **answer, notes=notes)


def _run_ceres(program: Path, unknowns: str, count: int) -> tuple[Array, Row]:
    """Return the solutions (n, count), and the statistics printed by the program."""
    numbers = np.concatenate([SENSOR.wavelengths, SENSOR.matrix.ravel(), LATTICE.nodes])
    lines = [f"{len(SENSOR.wavelengths)} {DIM}", *map(repr, numbers.tolist()), ""]
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "scene.txt")
        solution = Path(folder, "found")
        scene.write_text("\n".join(lines))
        # 12 iterations from each start: more, as by default, fit no more moments.
        options = [unknowns, str(count), "12"]
        # Ceres logs every step outside the moments of reflectances, which would be
        # timed too.
        quiet = os.environ | {"GLOG_minloglevel": "3"}
        done = subprocess.run(
            [program, scene, solution, *options],
            env=quiet,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            check=True,
        )
        return np.fromfile(solution).reshape(-1, count), json.loads(done.stdout)


RGB2SPEC = ROOT / "out" / "rgb2spec"
RGB2SPEC_DIM = 64
RGB2SPEC_NEEDS = (
    "get the source of rgb2spec by `make peers`, and install a C++ compiler: g++"
)
RGB2SPEC_VERSIONS = (
    ("e162107a2dfd7efe4384618ecd14e97d4a035685", "Gauss-Newton, double precision", 0.9),
    (
        "30a97d414f7cdb1c2c553daf3b4a83c333e6365e",
        "Levenberg-Marquardt, single precision",
        0.99,
    ),
)
"""Commit, method, and the minimum share of nodes that must be fitted."""
RGB2SPEC_FLAGS = ("-O3 -DNDEBUG", "-O3 -DNDEBUG -march=native -ffast-math")
"""Those of its CMakeLists.txt for a release, and the fastest."""
RGB2SPEC_COMPILES = ("-std=c++11", "-include", "algorithm", "-pthread")
"""Its standard, a header that the older version relies on others to include, and the
threads of the newer one.
"""


def rgb2spec(runs: int) -> list[Peer]:
    """Time the program that fits the tables of Jakob & Hanika 2019."""
    rows = []
    for (commit, method, least), flags in product(RGB2SPEC_VERSIONS, RGB2SPEC_FLAGS):
        program = RGB2SPEC / "rgb2spec_opt"
        source = RGB2SPEC / commit / "rgb2spec_opt.cpp"
        _install(
            RGB2SPEC_NEEDS,
            ["c++", *flags.split(), *RGB2SPEC_COMPILES, source, "-o", program],
        )
        with tempfile.NamedTemporaryFile() as table:
            command = [program, str(RGB2SPEC_DIM), table.name]
            fit = partial(
                subprocess.run, command, stdout=subprocess.DEVNULL, check=True
            )
            seconds = [children_cpu(fit) for _ in range(runs)]
            rgb, target = table_colours(Path(table.name))
        answer = check_answers(rgb, target, least=least)
        cpu = timing_stats(seconds).scaled(1e6 / len(target))
        tool = f"rgb2spec {commit[:7]}"
        notes = f"3 tables of {RGB2SPEC_DIM}³, {method}, C++, {flags}"
        rows.append(Peer(tool, "sigmoid", 3, len(target), cpu, **answer, notes=notes))
    return rows


def table_sensor() -> Sensor:
    """Return the sensor of rgb2spec: tables at 5 nm, linear between, by Simpson's 3/8
    rule, and a rounded matrix.
    """
    wide = observer.sensor(wavelengths=(360, 830, 5))
    wavelengths = np.linspace(360, 830, 3 * (len(wide.wavelengths) - 1) + 1)
    weights = np.full(len(wavelengths), 3.0)
    weights[::3] = 2
    weights[[0, -1]] = 1
    between = partial(np.interp, wavelengths, wide.wavelengths)
    return replace(
        wide,
        wavelengths=wavelengths,
        cmfs=np.stack(list(map(between, wide.cmfs.T)), axis=-1),
        power=between(wide.power) * weights,
        xyz_to_rgb=XYZ_TO_RGB,
    )


def table_colours(path: Path) -> tuple[Array, Array]:
    """Return the linear RGB (n, 3) of the spectra of a table of rgb2spec, and of its
    nodes.
    """
    # "SPEC", u32 dim, f32 scale[dim], f32 data[3][dim][dim][dim][3]
    data = path.read_bytes()
    dim = int.from_bytes(data[4:8], "little")
    numbers = np.frombuffer(data, "<f4", dim + 9 * dim**3, 8).astype(float)
    level = numbers[:dim]
    even = np.linspace(0, 1, dim)
    sensor = table_sensor()
    rgb = [
        sensor.rgb(evaluate_unscaled(plane, sensor.wavelengths))
        for plane in numbers[dim:].reshape(-1, dim * dim, 3)
    ]
    # In table l component l is the level; components l + 2 and l + 1 (modulo 3) are
    # even fractions of it.
    largest, last, middle = np.meshgrid(level, even, even, indexing="ij")
    target = np.stack([largest, middle * largest, last * largest], axis=-1)
    targets = [np.roll(target, table, axis=-1) for table in range(3)]
    return np.concatenate(rgb), np.concatenate(targets).reshape(-1, 3)
