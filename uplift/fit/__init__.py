"""From seeds to a lattice whose every point has a spectrum: solve, grow, improve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.fit.entries import fit_entries
from uplift.fit.grow import NEVER, Round, Watch, grow
from uplift.fit.improve import Improvement, improve
from uplift.fit.seed import Seeds, seed, separating_dim
from uplift.lattice import Indices, Lattice, Status
from uplift.models import Model
from uplift.models.least_change import Forward
from uplift.sensor import Array

__all__ = [
    "Fit",
    "Improvement",
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


def fit_lattice(
    model: Model,
    forward: Forward,
    lattice: Lattice,
    seeds: Seeds,
    entries: Array,
    *,
    threshold: float,
    watch: Watch = lambda done: None,
) -> Fit:
    """Fit every point of the lattice to within ``threshold``, max |linear RGB|.

    The solver goes on to a hundredth of it: the last steps converge quadratically and cost little.
    ``entries`` (E, C) are the multipliers of the atlas entries that ``seeds`` speaks of.
    """
    tolerance = threshold / 100
    limits = {"threshold": threshold, "tolerance": tolerance}
    grown = grow(model, forward, lattice, seeds, entries, watch=watch, **limits)
    multipliers, distance, improvements = improve(
        model, forward, lattice, grown.multipliers, grown.distance, **limits
    )
    status = np.full(lattice.size, Status.REGULAR, dtype=np.int64)
    entry = np.full(lattice.size, NO_ENTRY, dtype=np.int64)
    status[seeds.points] = np.where(seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER)
    entry[seeds.points] = seeds.entry
    status[(grown.round == NEVER) & (distance <= threshold)] = Status.IMPROVED
    status[distance > threshold] = Status.UNFITTED
    return Fit(multipliers, status, grown.round, entry, improvements)
