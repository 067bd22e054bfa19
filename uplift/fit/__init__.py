"""From seeds to a lattice whose every point has a spectrum: solve, grow, improve, store."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.fit.entries import FittedEntries, fit_entries
from uplift.fit.grow import grow
from uplift.fit.improve import Improvement, improve
from uplift.fit.lattice_size import DIMS, choose_lattice
from uplift.fit.objective import Weights
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import Problem
from uplift.fit.seed import Seeds, seed
from uplift.fit.store import store
from uplift.fit.unrealisable import Unrealisable, unrealisable
from uplift.lattice import NO_ENTRY, NOT_FITTED, PointTable, Status
from uplift.lattice.box_widths import half_widths

__all__ = [
    "DIMS",
    "Fit",
    "FittedEntries",
    "Improvement",
    "Prior",
    "Problem",
    "Seeds",
    "Unrealisable",
    "Weights",
    "choose_lattice",
    "fit_entries",
    "fit_lattice",
    "fit_prior",
    "half_widths",
    "seed",
    "unrealisable",
]


@dataclass(frozen=True, eq=False)
class Fit:
    """The fitted points, and the steps of the improvement pass."""

    points: PointTable
    improvements: tuple[Improvement, ...]


def fit_lattice(
    problem: Problem, seeds: Seeds, entries: Array, prior: Prior, progress: ProgressCallback = ignore_progress
) -> Fit:
    """Fit every point of the problem: seeds from the multipliers (E, C) of their entries, others from the prior.

    RGB, distance and status are judged by the coefficients, as any reader of them will. Points that no reflectance
    has the colour of are fitted to the nearest that is, and keep their distance from what they should have been.
    """
    entry = np.full(problem.lattice.size, NO_ENTRY, dtype=np.int32)
    entry[seeds.points] = seeds.entry

    def start(points: Indices) -> Array:
        found = prior(problem.goal(points))
        seeded = entry[points] != NO_ENTRY
        found[seeded] = entries[entry[points[seeded]]]
        return found

    grown = grow(problem, start, progress)
    improvements = improve(problem, grown.multipliers, grown.distance)
    stored = store(problem, grown.multipliers, grown.distance, progress)
    status = np.full(problem.lattice.size, Status.REGULAR, dtype=np.uint8)
    status[seeds.points] = np.where(seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER)
    status[grown.round == NOT_FITTED] = Status.IMPROVED
    beyond = problem.beyond.points
    status[beyond] = Status.UNREALISABLE
    status[stored.distance > problem.threshold] = Status.UNFITTED
    stored.distance[beyond] = np.abs(problem.lattice.target(beyond) - stored.rgb[beyond]).max(axis=1)
    status[beyond[stored.distance[beyond] <= problem.threshold]] = Status.REGULAR
    absent = problem.absent
    status[absent], entry[absent] = Status.ABSENT, NO_ENTRY
    errors = prior.standard_errors(problem)
    points = PointTable(stored.coefficients, stored.rgb, stored.distance, status, entry, grown.round, errors)
    return Fit(points, improvements)
