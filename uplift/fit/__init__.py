"""From seeds to a lattice whose every point has a spectrum: solve, grow, improve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.fit.entries import fit_entries
from uplift.fit.grow import NEVER, Round, Watch, grow
from uplift.fit.improve import Improvement, improve
from uplift.fit.problem import Problem
from uplift.fit.seed import Seeds, seed, separating_dim
from uplift.lattice import Indices, Status
from uplift.sensor import Array

__all__ = [
    "Fit",
    "Improvement",
    "Problem",
    "Round",
    "Seeds",
    "Watch",
    "fit_entries",
    "fit_lattice",
    "seed",
    "separating_dim",
]

NO_ENTRY = -1


@dataclass(frozen=True, eq=False)
class Fit:
    """Every lattice point's multipliers (n, C), `Status` (n,), round (n,) and entry (n,), −1 for none."""

    multipliers: Array
    status: Indices
    round: Indices
    entry: Indices
    improvements: tuple[Improvement, ...]


def fit_lattice(problem: Problem, seeds: Seeds, entries: Array, watch: Watch = lambda done: None) -> Fit:
    """Fit every point of the lattice. ``entries`` (E, C) are the multipliers that ``seeds`` speaks of."""
    grown = grow(problem, seeds, entries, watch)
    multipliers, distance, improvements = improve(problem, grown.multipliers, grown.distance)
    fitted = distance <= problem.threshold
    status = np.full(len(fitted), Status.REGULAR, dtype=np.int64)
    entry = np.full(len(fitted), NO_ENTRY, dtype=np.int64)
    status[seeds.points] = np.where(seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER)
    entry[seeds.points] = seeds.entry
    status[(grown.round == NEVER) & fitted] = Status.IMPROVED
    status[~fitted] = Status.UNFITTED
    return Fit(multipliers, status, grown.round, entry, improvements)
