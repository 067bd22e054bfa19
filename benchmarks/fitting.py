"""The fit of the Macbeth cube, phase by phase: compile and run apart, the answer checked first."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from itertools import pairwise

import jax
import numpy as np

from benchmarks.timing import ROOT
from uplift import fit
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.progress import Progress
from uplift.common.threads import single_threaded_blas
from uplift.lab.timing import Spread, spread
from uplift.lattice import Lattice
from uplift.models import Model, Moments, Sigmoid, reflectance
from uplift.models.minimum_norm import forward_map
from uplift.pipeline.options import Options

MODELS = (Sigmoid(), *(Moments(count) for count in (3, 5, 9, 13, 17)))
DIMS = (16, 32, 64, 128)
DIM = 64
ACCELERATED = (64, 128, 256)
FEW_RUNS = 3
"""Of the largest lattices, which take long and vary little."""


@dataclass(frozen=True)
class FitTiming:
    """CPU seconds of all threads, by phase; ``compile_seconds`` is what a first run takes longer.

    ``whole`` goes from the atlas to the last fitted point: entries, prior, growth and improvement. ``storing`` has the
    judging of what is stored, ``errors`` the standard errors. ``worst`` is max |linear RGB| of what is stored.
    """

    model: str
    count: int
    dim: int
    compile_seconds: float
    entries: Spread
    prior: Spread
    lattice: Spread
    storing: Spread
    errors: Spread
    whole: Spread
    wall: Spread
    worst: float


def time_dims(runs: int) -> list[FitTiming]:
    """9 moments coefficients at every dim."""
    return [time_fit(Moments(9), dim, runs if dim <= DIM else min(runs, FEW_RUNS)) for dim in DIMS]


def time_models(runs: int) -> list[FitTiming]:
    """Every model at one dim."""
    return [time_fit(model, DIM, min(runs, FEW_RUNS)) for model in MODELS]


def time_accelerator(runs: int) -> list[FitTiming]:
    """On a GPU, if JAX has one; nothing otherwise."""
    if jax.default_backend() == "cpu":
        return []
    return [time_fit(Moments(9), dim, runs) for dim in ACCELERATED]


def time_fit(model: Model, dim: int, runs: int) -> FitTiming:
    """Raises `RuntimeError` where a stored spectrum misses its colour: that would not be worth timing."""
    jax.clear_caches()
    begin = time.perf_counter()
    measured = _macbeth()
    _once(model, dim, measured)
    first = time.perf_counter() - begin
    laps = [_once(model, dim, measured) for _ in range(runs)]
    entries, prior, lattice, storing, errors, whole, wall = (
        spread([lap[phase] for lap, _ in laps])
        for phase in ("entries", "prior", "lattice", "storing", "errors", "whole", "wall")
    )
    compiling = max(first - wall.median, 0)
    worst = max(found for _, found in laps)
    return FitTiming(
        model.name, model.count, dim, compiling, entries, prior, lattice, storing, errors, whole, wall, worst
    )


@single_threaded_blas()
def _once(model: Model, dim: int, measured: Array) -> tuple[dict[str, float], float]:
    """CPU seconds of each phase of a whole fit as a build has it, and the worst stored point by our own evaluation."""
    sensor, lattice = observer.sensor(), Lattice(observer.axis_nodes("srgb", dim))
    problem = fit.Problem(model, forward_map(model, sensor.wavelengths, sensor.matrix), lattice)
    lights = [observer.light(name) for name in Options.lights]
    rgb = sensor.rgb(measured)
    marks: dict[str, float] = {}

    def mark(phase: str) -> None:
        marks[phase] = time.process_time()

    def progress(done: Progress) -> None:
        if done.stage == "fit":
            mark("lattice")

    wall = time.perf_counter()
    mark("begin")
    entries = fit.fit_entries(
        model, problem.forward, measured, rgb, lights, observer.light("A"), problem.tolerance
    )
    seeds = fit.seed(lattice, rgb)
    mark("entries")
    prior = fit.fit_prior(problem, sensor, entries, observer.light("A"))
    mark("prior")
    fitted = fit.fit_lattice(problem, seeds, entries.multipliers, prior, progress)
    mark("storing")
    prior.standard_errors(problem)
    mark("errors")
    wall = time.perf_counter() - wall
    phases = ("begin", "entries", "prior", "lattice", "storing", "errors")
    laps = {phase: marks[phase] - marks[last] for last, phase in pairwise(phases)}
    laps |= {"whole": marks["lattice"] - marks["begin"], "wall": wall}
    return laps, _worst(problem, sensor.wavelengths, sensor.matrix, fitted.coefficients)


def _worst(problem: fit.Problem, wavelengths: Array, matrix: Array, coefficients: Array) -> float:
    """Of every 64th point of large lattices, by numpy alone."""
    points = np.arange(0, len(coefficients), 64 if len(coefficients) > 1 << 20 else 1)
    worst = 0.0
    for part in np.array_split(points, -(-len(points) // 16384)):
        rgb = reflectance(problem.model, coefficients[part], wavelengths) @ matrix.T
        worst = max(worst, float(np.abs(rgb - problem.lattice.target(part)).max()))
    if worst > problem.threshold:
        raise RuntimeError(f"a wrong answer ({worst:.1e}) is not worth timing")
    return worst


def _macbeth() -> Array:
    """(E, N) the entries within sRGB."""
    sensor = observer.sensor()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        spectra = on_grid(read_atlas(ROOT / "atlases" / "macbeth.txt"), sensor.wavelengths)
    return spectra[sensor.holds(sensor.rgb(spectra))]
