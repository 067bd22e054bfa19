"""This package: lattices without an atlas, up to the stored coefficients."""

from __future__ import annotations

import numpy as np

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge_multipliers, model_of
from uplift.common.arrays import Array
from uplift.common.progress import ignore_progress
from uplift.fit.base import learn_base
from uplift.fit.growth import grow_from_prior
from uplift.fit.improve import improve
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.seeds import seed
from uplift.fit.store import store

DIMS = (16, 32)
MODELS = (("sigmoid", 3), ("moments", 3), ("moments", 5), ("moments", 9), ("moments", 17))


def ours(runs: int) -> list[Peer]:
    """Time every model at every dim."""
    return [_lattice(name, count, dim, runs) for dim in DIMS for name, count in MODELS]


def _lattice(name: str, count: int, dim: int, runs: int) -> Peer:
    model, sensor, lattice = model_of(name, count), task.sensor(), task.lattice(dim)
    problem, nobody = Problem(sensor, model), seed(lattice, np.empty((0, 3)))

    def fit_all() -> Array:
        nodes = nodes_of(lattice, sensor, problem.threshold / 2)
        prior = Prior(model, sensor, learn_base(problem)[0])
        growth = grow_from_prior(problem, nodes, lambda at: prior(nodes.goal(at)), nobody.points, ignore_progress)
        improve(growth)
        return store(growth, nobody, None).coefficients

    fit_all()  # compiles
    stored, cpu = task.measured(fit_all, lattice.size, runs)
    answer = judge_multipliers(model, model.from_storage(stored), sensor, lattice.points, least=1.0)
    return Peer("uplift", name, count, lattice.size, cpu, answer, f"{dim}³, compiled before")
