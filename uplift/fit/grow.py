"""Growth: rounds outward from the seeds, each point from its fitted neighbours (Tódová 2020, 3.1.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.fit.problem import Problem
from uplift.fit.seed import Seeds
from uplift.lattice import Indices, Lattice, Mask
from uplift.sensor import Array

PASSES = 6
NEVER = -1
"""The round of a point that no round has fitted."""


@dataclass(frozen=True)
class Round:
    """What a round did, for whoever watches: points tried in it, fitted so far, and in all."""

    number: int
    tried: int
    fitted: int
    total: int


Watch = Callable[[Round], None]


@dataclass(frozen=True, eq=False)
class Growth:
    """Multipliers (n, C), distance (n,) and round (n,) of every lattice point, −1 where none fitted it."""

    multipliers: Array
    distance: Array
    round: Indices


def grow(problem: Problem, seeds: Seeds, entries: Array, watch: Watch) -> Growth:
    """Fit the whole lattice. ``entries`` (E, C) are the multipliers of the atlas entries.

    A point that fails is tried again whenever another of its neighbours has been fitted.
    """
    lattice = problem.lattice
    multipliers = np.zeros((lattice.size, problem.model.count))
    distance = np.full(lattice.size, np.inf)
    rounds = np.full(lattice.size, NEVER, dtype=np.int64)
    points, start = _beginning(problem, seeds, entries)
    number = 0
    while points.size:
        found = problem.solve(points, start, PASSES)
        better = found.distance < distance[points]
        multipliers[points[better]] = found.multipliers[better]
        distance[points[better]] = found.distance[better]
        fresh = points[found.distance <= problem.threshold]
        rounds[fresh] = number
        watch(Round(number, len(points), int((rounds != NEVER).sum()), lattice.size))
        points, start = _frontier(lattice, fresh, rounds != NEVER, multipliers)
        number += 1
    return Growth(multipliers, distance, rounds)


def _beginning(problem: Problem, seeds: Seeds, entries: Array) -> tuple[Indices, Array]:
    """The seeds with their entries' spectra or, without an atlas, the middle of the lattice with a grey."""
    if len(seeds.points):
        return seeds.points, entries[seeds.entry]
    middle = np.abs(problem.lattice.points - 0.5).sum(axis=1).argmin()
    return np.array([middle]), np.zeros((1, problem.model.count))


def _frontier(lattice: Lattice, fresh: Indices, fitted: Mask, multipliers: Array) -> tuple[Indices, Array]:
    """The unfitted neighbours of freshly fitted points, and the mean of their own fitted neighbours."""
    around, inside = lattice.neighbours(fresh)
    points = np.unique(around[inside])
    points = points[~fitted[points]]
    around, inside = lattice.neighbours(points)
    known = inside & fitted[around]
    total = np.zeros((len(points), multipliers.shape[1]))
    for column in range(around.shape[1]):
        total += np.where(known[:, column, None], multipliers[around[:, column]], 0)
    return points, total / np.maximum(known.sum(axis=1), 1)[:, None]
