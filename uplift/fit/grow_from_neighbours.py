"""Growth from neighbours: outward from seeds in rounds, each point from the spectra of its fitted neighbours.

The algorithm of Tódová 2020, section 3.1.3, for any model and solver. `uplift.fit.grow` is the default;
docs/growth.md compares the two.
"""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import Growth, PointPrior, blocks
from uplift.fit.problem import Problem
from uplift.lattice import NOT_FITTED

NUDGES = (0.5, -0.5)
"""Changes of the linear part that are tried, in turn, where the solver fails."""


def grow_from_neighbours(problem: Problem, prior: PointPrior, seeds: Indices, progress: ProgressCallback) -> Growth:
    """Fit all active points of a problem that can be reached from its seeds.

    Parameters
    ----------
    problem : Problem
        The points and their goals.
    prior : callable
        Multipliers of the seeds.
    seeds : ndarray of int, shape (S,)
        Points that start from atlas entries. Without any, growth starts in the middle, from grey.
    progress : callable
        Called with `Progress` events of the stage ``"fit"``.

    Returns
    -------
    Growth
        Multipliers, distances and rounds.
    """
    growth = Growth(problem, progress)
    seeds = np.intersect1d(seeds, problem.points)
    first = seeds if seeds.size else _middle(problem)
    fresh = _try(growth, first, prior(first) if seeds.size else growth.multipliers[first], 0)
    number = 1
    while fresh.size:
        is_fresh = np.zeros(problem.lattice.size, dtype=bool)
        is_fresh[fresh] = True
        tried = [_from_neighbours(growth, block, is_fresh, number) for block in blocks(growth.waiting)]
        fresh = np.concatenate([fresh[:0], *tried])
        number += 1
    return growth


def _middle(problem: Problem) -> Indices:
    """The active point nearest to the middle of the lattice."""
    position = problem.lattice.position(problem.points)
    away = np.abs(2 * position - (problem.lattice.dim - 1)).sum(axis=1)
    return problem.points[[int(away.argmin())]]


def _from_neighbours(growth: Growth, points: Indices, is_fresh: Mask, number: int) -> Indices:
    """Try waiting points from each of their fresh neighbours in turn, and return those that are fitted now."""
    neighbours, inside = growth.problem.lattice.neighbours(points)
    known = inside & is_fresh[neighbours]
    adjacent = known.any(axis=1)
    points, neighbours, known = points[adjacent], neighbours[adjacent], known[adjacent]
    order = np.argsort(~known, axis=1, kind="stable")
    waiting = np.arange(len(points))
    for turn in range(known.shape[1]):
        waiting = waiting[known[waiting].sum(axis=1) > turn]
        if not waiting.size:
            break
        source = neighbours[waiting, order[waiting, turn]]
        _try(growth, points[waiting], growth.multipliers[source], number)
        waiting = waiting[growth.round[points[waiting]] == NOT_FITTED]
    growth.report(number, len(points))
    return points[growth.round[points] != NOT_FITTED]


def _try(growth: Growth, points: Indices, start: Array, number: int) -> Indices:
    """Solve points from ``start``, then from their best multipliers so far with the first one nudged."""
    growth.attempt(points, start, number)
    for nudge in NUDGES:
        failed = points[growth.round[points] == NOT_FITTED]
        if not failed.size:
            break
        best = growth.multipliers[failed]
        growth.attempt(failed, best + nudge * growth.problem.model.constant(), number)
    return points[growth.round[points] != NOT_FITTED]
