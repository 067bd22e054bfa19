"""Growth: every point from its prior; those that fail, round after round, from fitted neighbours.

Tódová 2020, 3.1.3, starts every point from neighbours, as a point has nothing else there. A prior
(`uplift.fit.prior`) is nearer and the same for whichever way growth takes: docs/fidelity.md.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.problem import Problem
from uplift.lattice import NOT_FITTED, Lattice

PASSES = 24
BLOCK = 1 << 15
"""Points worked on at a time."""


@dataclass(frozen=True, eq=False)
class Growth:
    """Multipliers (n, C), distance (n,) and round (n,) of every lattice point, −1 where none fitted it.

    Of points that are not wanted: 0, infinity, −1.
    """

    multipliers: Array
    distance: Array
    round: NDArray[np.int16]


Start = Callable[[Indices], Array]
"""Multipliers (k, C) that points (k,) start from."""


def grow(problem: Problem, start: Start, progress: ProgressCallback) -> Growth:
    """Fit all points of the problem, each from its start.

    A point that fails is tried again whenever another of its neighbours has been fitted.
    """
    lattice, wanted = problem.lattice, problem.points
    growth = Growth(
        np.zeros((lattice.size, problem.model.count)),
        np.full(lattice.size, np.inf),
        np.full(lattice.size, NOT_FITTED, dtype=np.int16),
    )
    fitted = 0
    for first in range(0, len(wanted), BLOCK):
        points = wanted[first : first + BLOCK]
        fitted += len(_try(problem, growth, points, start(points), 0))
        progress(_round(0, len(points), fitted, len(wanted)))
    number, fresh = 1, np.flatnonzero(growth.round == 0)
    while fresh.size:
        waiting = wanted[growth.round[wanted] == NOT_FITTED]
        points, means = _frontier(lattice, waiting, fresh, growth)
        if not points.size:
            break
        fresh = _try(problem, growth, points, means, number)
        fitted += len(fresh)
        progress(_round(number, len(points), fitted, len(wanted)))
        number += 1
    return growth


def _round(number: int, tried: int, fitted: int, total: int) -> Progress:
    return Progress("fit", fitted, total, step=number, detail=f"round {number}: {tried} tried")


def _try(problem: Problem, growth: Growth, points: Indices, start: Array, number: int) -> Indices:
    """Solve points (k,) from ``start`` (k, C), keep what is better, and say which are fitted now."""
    found = problem.solve(problem.goal(points), start, PASSES)
    better = found.distance < growth.distance[points]
    growth.multipliers[points[better]] = found.multipliers[better]
    growth.distance[points[better]] = found.distance[better]
    fresh = points[found.distance <= problem.threshold]
    growth.round[fresh] = number
    return fresh


def _frontier(lattice: Lattice, waiting: Indices, fresh: Indices, growth: Growth) -> tuple[Indices, Array]:
    """The waiting neighbours of freshly fitted points, and the mean of their own fitted neighbours."""
    multipliers, fitted, new = growth.multipliers, growth.round != NOT_FITTED, _mask(lattice, fresh)
    points = [waiting[:0]]
    means = [np.zeros((0, multipliers.shape[1]))]
    for first in range(0, len(waiting), BLOCK):
        around, inside = lattice.neighbours(waiting[first : first + BLOCK])
        beside = (inside & new[around]).any(axis=1)
        points.append(waiting[first : first + BLOCK][beside])
        around = around[beside]
        known = inside[beside] & fitted[around]
        total = np.zeros((len(around), multipliers.shape[1]))
        for column in range(around.shape[1]):
            total += np.where(known[:, column, None], multipliers[around[:, column]], 0)
        means.append(total / np.maximum(known.sum(axis=1), 1)[:, None])
    return np.concatenate(points), np.concatenate(means)


def _mask(lattice: Lattice, points: Indices) -> Mask:
    mask = np.zeros(lattice.size, dtype=bool)
    mask[points] = True
    return mask
