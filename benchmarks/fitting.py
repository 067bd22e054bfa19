"""CPU time of the fit of the Macbeth cube by phase; compilation is separate, and results are checked before timing."""

from __future__ import annotations

import time
import warnings
from itertools import pairwise
from typing import Any

import jax
import numpy as np

from benchmarks.record import ROOT
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.progress import Progress
from uplift.common.threads import single_threaded_blas
from uplift.fit.base import learn_base
from uplift.fit.entries import fit_entries
from uplift.fit.growth import grow_from_prior
from uplift.fit.improve import improve
from uplift.fit.prior import fit_prior
from uplift.fit.problem import Nodes, Problem, nodes_of
from uplift.fit.seeds import InitialGuess, learnt_blend, seed
from uplift.fit.store import store
from uplift.lab.timing import spread
from uplift.lattice import Lattice
from uplift.models import Model, Moments, Sigmoid, reflectance
from uplift.pipeline.entries import families_of
from uplift.pipeline.options import Options

MODELS = (Sigmoid(), *(Moments(count) for count in (3, 5, 9, 13, 17)))
DIMS = (16, 32, 64, 128)
DIM = 64
ACCELERATED = (64, 128, 256)
FEW_RUNS = 3
"""For the largest lattices, which take long and vary little."""
PER_NODE = ("whole", "lattice", "storing", "errors")


Timing = dict[str, Any]
"""CPU times of all threads: in µs per node where the key ends in ``_us``, in ms where it ends in ``_ms``.

``whole`` runs from the atlas to the last fitted node: entries, prior, growth and improvement. ``storing`` includes the
evaluation of the stored coefficients, ``errors`` are the standard errors. ``compile_s`` is the extra time of a first
run, ``worst`` the largest |linear RGB| between a stored spectrum and its node.
"""


def time_dims(runs: int) -> list[Timing]:
    """Time nine moment coefficients at every dim."""
    return [time_fit(Moments(9), dim, runs if dim <= DIM else min(runs, FEW_RUNS)) for dim in DIMS]


def time_models(runs: int) -> list[Timing]:
    """Time every model at one dim."""
    return [time_fit(model, DIM, min(runs, FEW_RUNS)) for model in MODELS]


def time_accelerator(runs: int) -> list[Timing]:
    """Time the fit on a GPU; return an empty list if JAX has none."""
    if jax.default_backend() == "cpu":
        return []
    return [time_fit(Moments(9), dim, runs) for dim in ACCELERATED]


def time_fit(model: Model, dim: int, runs: int) -> Timing:
    """Time a fit. Raises `RuntimeError` if a stored spectrum does not have its colour."""
    jax.clear_caches()
    begin = time.perf_counter()
    measured = _macbeth()
    _fit_once(model, dim, measured)
    first = time.perf_counter() - begin
    laps = [_fit_once(model, dim, measured) for _ in range(runs)]
    seconds = {phase: spread([lap[phase] for lap, _ in laps]) for phase in laps[0][0]}
    per_node = 1e6 / dim**3
    return {
        "model": model.name,
        "coefficients": model.count,
        "dim": dim,
        "nodes": dim**3,
        "compile_s": max(first - seconds["wall"].median, 0),
        "wall_s": seconds["wall"],
        **{f"{phase}_us": seconds[phase].scaled(per_node) for phase in PER_NODE},
        "constant_us": (seconds["entries"].median + seconds["prior"].median) * per_node,
        "entries_ms": seconds["entries"].scaled(1e3),
        "worst": max(worst for _, worst in laps),
    }


@single_threaded_blas()
def _fit_once(model: Model, dim: int, measured: Array) -> tuple[dict[str, float], float]:
    """Return the CPU seconds of each phase of a fit as in a build, and the largest residual of the stored nodes."""
    sensor, lattice = observer.sensor(), Lattice(observer.axis_nodes("srgb", dim))
    problem = Problem(sensor, model, tuple(map(observer.light, Options.lights)), observer.light("A"))
    rgb = sensor.rgb(measured)
    marks: dict[str, float] = {}

    def mark(phase: str) -> None:
        marks[phase] = time.process_time()

    def progress(done: Progress) -> None:
        if done.stage in ("fit", "store"):
            mark("lattice" if done.stage == "fit" else "storing")

    wall = time.perf_counter()
    mark("begin")
    entries = fit_entries(problem, measured, rgb)
    seeds = seed(lattice, rgb)
    mark("entries")
    base, _ = learn_base(problem, families_of(Options(), (), sensor), entries)
    prior = fit_prior(problem, entries, base)
    mark("prior")
    guess = InitialGuess(prior, seeds, entries.multipliers, learnt_blend(prior))
    nodes = nodes_of(lattice, sensor, problem.threshold / 2)
    growth = grow_from_prior(problem, nodes, lambda at: guess(at, nodes.goal(at)), seeds.points, progress)
    improve(growth)
    points = store(growth, seeds, None)
    prior.standard_errors(nodes)
    mark("errors")
    wall = time.perf_counter() - wall
    phases = ("begin", "entries", "prior", "lattice", "storing", "errors")
    laps = {phase: marks[phase] - marks[last] for last, phase in pairwise(phases)}
    laps |= {"whole": marks["lattice"] - marks["begin"], "wall": wall}
    return laps, _worst(problem, nodes, points.coefficients)


def _worst(problem: Problem, nodes: Nodes, coefficients: Array) -> float:
    """Return the largest residual, of every 64th node if the lattice is large, evaluated by numpy."""
    points = np.arange(0, len(coefficients), 64 if len(coefficients) > 1 << 20 else 1)
    worst = 0.0
    for part in np.array_split(points, -(-len(points) // 16384)):
        rgb = problem.sensor.rgb(reflectance(problem.model, coefficients[part], problem.sensor.wavelengths))
        worst = max(worst, float(np.abs(rgb - nodes.lattice.target(part)).max()))
    if worst > problem.threshold:
        raise RuntimeError(f"residual {worst:.1e} exceeds the threshold: nothing to time")
    return worst


def _macbeth() -> Array:
    """Return the spectra (E, N) of the entries inside sRGB."""
    sensor = observer.sensor()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        spectra = on_grid(read_atlas(ROOT / "atlases" / "macbeth.txt"), sensor.wavelengths)
    return spectra[sensor.contains(sensor.rgb(spectra))]
