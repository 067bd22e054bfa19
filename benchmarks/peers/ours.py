"""This package: lattices without an atlas, up to the stored coefficients."""

from __future__ import annotations

import numpy as np

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge_multipliers, model_of
from uplift import fit
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.models.minimum_norm import forward_map

DIMS = (16, 32)
MODELS = (("sigmoid", 3), ("moments", 3), ("moments", 5), ("moments", 9), ("moments", 17))


def ours(runs: int) -> list[Peer]:
    """Time every model at every dim."""
    return [_lattice(name, count, dim, runs) for dim in DIMS for name, count in MODELS]


def _lattice(name: str, count: int, dim: int, runs: int) -> Peer:
    model, sensor, lattice = model_of(name, count), task.sensor(), task.lattice(dim)
    problem = fit.Problem(model, forward_map(model, sensor.wavelengths, sensor.matrix), lattice)
    reference = observer.light("A")
    rgb, measured = np.empty((0, 3)), np.empty((0, len(sensor.wavelengths)))
    none = fit.fit_entries(model, problem.forward, measured, rgb, [reference], reference, problem.tolerance)
    seeds = fit.seed(lattice, rgb)

    def fit_all() -> Array:
        prior = fit.fit_prior(problem, sensor, none, [reference], reference)
        return fit.fit_lattice(problem, fit.Starts(prior, seeds, none.multipliers)).points.coefficients

    fit_all()  # compiles
    stored, cpu = task.measured(fit_all, lattice.size, runs)
    answer = judge_multipliers(model, model.from_storage(stored), sensor, lattice.points, least=1.0)
    return Peer("uplift", name, count, lattice.size, cpu, answer, f"{dim}³, compiled before")
