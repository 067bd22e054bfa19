"""The fit of the Macbeth cube, phase by phase: compile and run apart, the answer checked first."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass

import jax
import numpy as np

from benchmarks.timing import ROOT, Spread, timed
from uplift import fit, observer
from uplift.atlas import on_grid, read_atlas
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.models.least_change import forward
from uplift.options import Options

THRESHOLD = 1e-4


@dataclass(frozen=True)
class FitTiming:
    """One dim: seconds to compile (and run once, less a run), of runs, per phase; and how good the answer is."""

    dim: int
    compile_seconds: float
    entries: Spread
    lattice: Spread
    lattice_cpu: Spread
    storage: Spread
    worst: float


def time_fit(dim: int, runs: int) -> FitTiming:
    model, sensor = Moments(9), observer.sensor()
    lattice = Lattice(observer.axis_nodes("srgb", dim))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        spectra = on_grid(read_atlas(ROOT / "atlases" / "macbeth.txt"), sensor.wavelengths)
    measured = spectra[sensor.holds(sensor.rgb(spectra))]
    ahead = forward(model, sensor.wavelengths, sensor.matrix)
    problem = fit.Problem(model, ahead, lattice, THRESHOLD)
    lights = [observer.light(name) for name in Options.lights]
    rgb = sensor.rgb(measured)
    seeds = fit.seed(lattice, rgb)

    def entries() -> fit.Entries:
        return fit.fit_entries(model, ahead, measured, rgb, lights, lights[1], problem.tolerance)

    jax.clear_caches()
    begin = time.perf_counter()
    found = entries()

    def points() -> fit.Fit:
        prior = fit.learn(problem, sensor, found, lights[1])
        return fit.fit_lattice(problem, seeds, found.multipliers, prior)

    fitted = points()
    first = time.perf_counter() - begin
    back = model.squash(model.from_storage(model.to_storage(fitted.multipliers)) @ ahead.basis.T)
    worst = float(np.abs(sensor.rgb(back) - lattice.points).max())
    if worst > THRESHOLD:
        raise RuntimeError(f"dim {dim}: a wrong answer ({worst:.1e}) is not worth timing")
    entry_wall, _ = timed(entries, runs)
    wall, cpu = timed(points, runs)
    storage, _ = timed(lambda: model.from_storage(model.to_storage(fitted.multipliers)), runs)
    return FitTiming(
        dim, max(first - entry_wall.median - wall.median, 0), entry_wall, wall, cpu, storage, worst
    )
