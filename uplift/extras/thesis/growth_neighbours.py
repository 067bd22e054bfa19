"""Growth from neighbours: outward from seeds in rounds, each node from the spectra of
its fitted neighbours.

The algorithm of Tódová 2020, section 3.1.3, for any model and solver; docs/accuracy.md
compares it with the default.
"""

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import Expected, Growth
from uplift.fit.problem import Nodes, Problem
from uplift.lattice.point_table import NOT_FITTED

NUDGES = (0.5, -0.5)
"""Changes of the linear part that are tried, in turn, where the solver fails."""


def grow_from_neighbours(
    problem: Problem,
    nodes: Nodes,
    expected: Expected,
    seeds: Indices,
    progress: ProgressCallback,
) -> Growth:
    """Fit nodes that can be reached from seeds (S,).

    Without seeds, growth starts at the node of ``nodes`` that is nearest to the middle,
    from grey.
    """
    growth = Growth(problem, nodes, progress)
    lattice = nodes.lattice
    seeds = np.intersect1d(seeds, nodes.points)
    if seeds.size:
        start = expected(seeds, nodes.goal(seeds))
    else:
        away = np.abs(2 * lattice.position(nodes.points) - (lattice.dim - 1)).sum(
            axis=1
        )
        seeds = nodes.points[[int(away.argmin())]]
        start = growth.multipliers[seeds]
    # Shell by shell: waiting neighbours of the nodes that the last round fitted.
    fresh = _try(growth, seeds, start, 0)
    number = 1
    while fresh.size:
        is_fresh = lattice.mask(fresh)
        tried = [
            _try_neighbours(growth, block, is_fresh, number)
            for block in growth.waiting_blocks()
        ]
        fresh = np.concatenate([fresh[:0], *tried])
        number += 1
    return growth


def _try_neighbours(
    growth: Growth, points: Indices, is_fresh: Mask, number: int
) -> Indices:
    """Try waiting nodes from each of their fresh neighbours in turn, and return those
    that are fitted now.
    """
    neighbours, inside = growth.nodes.lattice.neighbours(points)
    known = inside & is_fresh[neighbours]
    adjacent = known.any(axis=1)
    points = points[adjacent]
    neighbours = neighbours[adjacent]
    known = known[adjacent]
    order = np.argsort(~known, axis=1, kind="stable")
    waiting = np.arange(len(points))
    for turn in range(known.shape[1]):
        waiting = waiting[known[waiting].sum(axis=1) > turn]
        if not waiting.size:
            break
        source = neighbours[waiting, order[waiting, turn]]
        _try(growth, points[waiting], growth.multipliers[source], number)
        waiting = waiting[growth.round[points[waiting]] == NOT_FITTED]
    return points[growth.round[points] != NOT_FITTED]


def _try(growth: Growth, points: Indices, start: Array, number: int) -> Indices:
    """Solve nodes from ``start``, then from their best multipliers so far with the
    first one nudged.
    """
    growth.attempt(points, start, number)
    for nudge in NUDGES:
        failed = points[growth.round[points] == NOT_FITTED]
        if not failed.size:
            break
        best = growth.multipliers[failed]
        growth.attempt(failed, best + nudge * growth.problem.model.constant(), number)
    return points[growth.round[points] != NOT_FITTED]
