"""Growth: fit every point from its start, then failed points from the mean of their fitted neighbours, in rounds.

Tódová 2020, section 3.1.3, starts every point from its neighbours. Here the prior (`uplift.fit.prior`) gives a closer
start that does not depend on the order of growth; docs/fidelity.md compares the two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.problem import Problem
from uplift.lattice import NOT_FITTED, Lattice

MAX_PASSES = 24
BLOCK_POINTS = 1 << 15
"""Points processed at a time."""


@dataclass(frozen=True, eq=False)
class Growth:
    """State of growth over all n lattice points.

    Parameters
    ----------
    multipliers : ndarray, shape (n, C)
        Best multipliers so far, 0 at inactive points.
    distance : ndarray, shape (n,)
        Their distance from the goal, infinite at inactive points.
    round : ndarray of int16, shape (n,)
        Round in which the point was fitted, −1 if it was not.
    """

    multipliers: Array
    distance: Array
    round: NDArray[np.int16]


Start = Callable[[Indices], Array]
"""From points (k,) to the multipliers (k, C) that they start from."""


def grow(problem: Problem, start: Start, progress: ProgressCallback) -> Growth:
    """Fit all active points of a problem, each from its start.

    A point that fails is tried again whenever another of its neighbours has been fitted.
    """
    lattice, active = problem.lattice, problem.points
    growth = Growth(
        np.zeros((lattice.size, problem.model.count)),
        np.full(lattice.size, np.inf),
        np.full(lattice.size, NOT_FITTED, dtype=np.int16),
    )
    fitted = 0
    for first in range(0, len(active), BLOCK_POINTS):
        points = active[first : first + BLOCK_POINTS]
        fitted += len(_try(problem, growth, points, start(points), 0))
        progress(_progress(0, len(points), fitted, len(active)))
    number, fresh = 1, np.flatnonzero(growth.round == 0)
    while fresh.size:
        waiting = active[growth.round[active] == NOT_FITTED]
        points, means = _frontier(lattice, waiting, fresh, growth)
        if not points.size:
            break
        fresh = _try(problem, growth, points, means, number)
        fitted += len(fresh)
        progress(_progress(number, len(points), fitted, len(active)))
        number += 1
    return growth


def _progress(number: int, tried: int, fitted: int, total: int) -> Progress:
    return Progress("fit", fitted, total, step=number, detail=f"round {number}: {tried} tried")


def _try(problem: Problem, growth: Growth, points: Indices, start: Array, number: int) -> Indices:
    """Solve points (k,) from ``start`` (k, C), keep improvements, and return the points that are fitted now."""
    found = problem.solve(problem.goal(points), start, MAX_PASSES)
    better = found.distance < growth.distance[points]
    growth.multipliers[points[better]] = found.multipliers[better]
    growth.distance[points[better]] = found.distance[better]
    fresh = points[found.distance <= problem.threshold]
    growth.round[fresh] = number
    return fresh


def _frontier(lattice: Lattice, waiting: Indices, fresh: Indices, growth: Growth) -> tuple[Indices, Array]:
    """The waiting neighbours of freshly fitted points, and the mean multipliers of their own fitted neighbours."""
    multipliers, fitted = growth.multipliers, growth.round != NOT_FITTED
    is_fresh = np.zeros(lattice.size, dtype=bool)
    is_fresh[fresh] = True
    points, means = [waiting[:0]], [np.zeros((0, multipliers.shape[1]))]
    for first in range(0, len(waiting), BLOCK_POINTS):
        block = waiting[first : first + BLOCK_POINTS]
        neighbours, inside = lattice.neighbours(block)
        adjacent = (inside & is_fresh[neighbours]).any(axis=1)
        neighbours, inside = neighbours[adjacent], inside[adjacent]
        known = inside & fitted[neighbours]
        total = np.zeros((len(neighbours), multipliers.shape[1]))
        for column in range(neighbours.shape[1]):
            total += np.where(known[:, column, None], multipliers[neighbours[:, column]], 0)
        points.append(block[adjacent])
        means.append(total / np.maximum(known.sum(axis=1), 1)[:, None])
    return np.concatenate(points), np.concatenate(means)
