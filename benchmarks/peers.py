"""Other tools on the task of a build: CPU time per fitted node and accuracy, for
docs/speed.md.

The task is the lattice of linear sRGB under D65, without an atlas. Answers are checked,
and a tool that is not installed is a question that fails.
"""

import json
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ROOT, Row
from benchmarks.programs import Words, output
from uplift.colorimetry import Sensor, observer
from uplift.common.arrays import Array
from uplift.lab.methods.mitsuba3 import XYZ_TO_RGB
from uplift.lab.timing import time_call, time_command, timing_stats
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
MODELS = (("sigmoid", 3), ("moments", 9))
RUNS = 3


def check_share(rgb: Array, target: Array, *, least: float) -> Row:
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
    return {"points": len(target), "share": share, "worst": residual.max()}


def install(needs: str, *commands: list[Words]) -> None:
    """Run commands that compile a tool. Raises `RuntimeError` with what it needs."""
    try:
        for command in commands:
            subprocess.run(command, capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise RuntimeError(needs) from error


def ours() -> Iterator[Row]:
    """Yield our builds of the lattice of Ceres and of the size of rgb2spec, with smooth
    spectra as the prior.
    """
    for dim, (name, count) in product((DIM, RGB2SPEC_DIM), MODELS):
        build = partial(
            uplift.build, dim=dim, model=name, coefficients=count, prior="smooth"
        )
        data = build().data  # compiles
        spectra = reflectance(data.model, data.points.coefficients, SENSOR.wavelengths)
        answer = check_share(SENSOR.rgb(spectra), data.lattice.points, least=1.0)
        cpu = time_call(build, RUNS).cpu.scaled(1e6 / dim**3)
        row = {"tool": "uplift", "model": name, "count": count, "cpu_us": cpu}
        yield row | answer | {"notes": f"{dim}³, compiled before"}


CERES_SOURCE = ROOT / "benchmarks" / "ceres"
CERES_BUILT = ROOT / "out" / "ceres"
CERES_NEEDS = "install Ceres, cmake and a C++ compiler: libceres-dev, cmake, g++"
CERES_JOBS = (
    ("sigmoid", 3, "sigmoid", 0.99),
    ("moments", 9, "moments", 0.5),
    ("moments", 9, "multipliers", 0.99),
)
"""Model, coefficients, unknowns, and the minimum share of nodes that must be fitted."""


def ceres() -> Iterator[Row]:
    """Yield the solver of the thesis with numeric differences
    (`benchmarks/ceres/fit.cpp`).

    It grows from the middle of the lattice, every node from its fitted neighbours.
    """
    install(
        CERES_NEEDS,
        ["cmake", "-S", CERES_SOURCE, "-B", CERES_BUILT],
        ["cmake", "--build", CERES_BUILT],
    )
    points = LATTICE.points
    for name, count, unknowns, least in CERES_JOBS:
        runs = [run_ceres(unknowns, count) for _ in range(RUNS)]
        solution, facts = runs[-1]
        model = Sigmoid() if name == "sigmoid" else Moments(count)
        if unknowns == "moments":
            solution = model.from_storage(solution)
        spectra = evaluate(model, solution, SENSOR.wavelengths)
        answer = check_share(SENSOR.rgb(spectra), points, least=least)
        cpu = timing_stats([figures["cpu"] for _, figures in runs])
        starts = facts["solves"] / len(points)
        yield {
            "tool": f"Ceres {facts['ceres']}",
            "model": name,
            "count": count,
            "cpu_us": cpu.scaled(1e6 / len(points)),
            **answer,
            "notes": f"{DIM}³, unknowns: {unknowns}, numeric differences, C++; grown "
            f"from the middle, {starts:.1f} starts a point",
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
        quiet = ("env", "GLOG_minloglevel=3", CERES_BUILT / "fit")
        options = ("scene.txt", "found", unknowns, str(count), "12")
        printed = output(*quiet, *options, folder=folder)
        return np.fromfile(folder / "found").reshape(-1, count), json.loads(printed)


RGB2SPEC = ROOT / "out" / "rgb2spec"
RGB2SPEC_DIM = 64
RGB2SPEC_RUNS = 2
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


def rgb2spec() -> Iterator[Row]:
    """Yield the program that fits the tables of Jakob & Hanika 2019."""
    program = RGB2SPEC / "rgb2spec_opt"
    for (commit, method, least), flags in product(RGB2SPEC_VERSIONS, RGB2SPEC_FLAGS):
        source = RGB2SPEC / commit / "rgb2spec_opt.cpp"
        compiler = ["c++", *flags.split(), *RGB2SPEC_COMPILES]
        install(RGB2SPEC_NEEDS, [*compiler, source, "-o", program])
        with tempfile.NamedTemporaryFile() as table:
            fit = [program, str(RGB2SPEC_DIM), table.name]
            timing = time_command(fit, RGB2SPEC_RUNS)
            rgb, target = table_colours(Path(table.name))
        answer = check_share(rgb, target, least=least)
        yield {
            "tool": f"rgb2spec {commit[:7]}",
            "model": "sigmoid",
            "count": 3,
            "cpu_us": timing.cpu.scaled(1e6 / len(target)),
            **answer,
            "notes": f"3 tables of {RGB2SPEC_DIM}³, {method}, C++, {flags}",
        }


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


QUESTIONS = {"ours": ours, "ceres": ceres, "rgb2spec": rgb2spec}
