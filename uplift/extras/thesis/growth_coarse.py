"""Growth from a coarse lattice to finer ones: corrections are interpolated between
nodes of earlier rounds.
"""

import numpy as np

from uplift.common.arrays import Array, Indices, blocks
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import BLOCK_POINTS, MAX_PASSES, Expected, Growth, retry
from uplift.fit.problem import Nodes, Problem
from uplift.lattice.lattice import weighted_sum

MIN_CELLS = 4
"""Cells along each axis of the coarsest lattice, at least; all of them in smaller
lattices.
"""
ALL = 1 - 1e-9
"""Sum of the weights of known corners above which all corners are known."""


def strides(dim: int) -> list[int]:
    """Lattice steps between the nodes of each round: powers of two down to 1."""
    return [
        1 << power for power in reversed(range(max((dim // MIN_CELLS).bit_length(), 1)))
    ]


def grow_coarse_to_fine(
    problem: Problem,
    nodes: Nodes,
    expected: Expected,
    seeds: Indices,
    progress: ProgressCallback,
) -> Growth:
    """Fit nodes from the prior. Seeds (S,) are fitted in the first round, and give and
    take no correction.
    """
    growth = Growth(problem, nodes, progress)
    lattice = nodes.lattice
    waiting = lattice.mask(nodes.points)
    seeded = lattice.mask(seeds)
    # Corrections p − p₀ at every second node, which are known if smooth, and the rows
    # of nodes. Weights of known ones are interpolated like corrections.
    half, numbers = lattice.thinned(2)
    corrections = np.zeros((half.size, problem.model.count + 1))
    row = np.full(lattice.size, -1, dtype=np.int32)
    row[numbers] = np.arange(half.size)
    row[seeds] = -1

    def fit(
        points: Indices, start: Array, prior: Array, number: int, max_passes: int
    ) -> tuple[Indices, Array, Array]:
        """Fit nodes, store their corrections, and return those that are not solved."""
        solution = growth.attempt(points, start, number, prior, max_passes)
        correction = solution.multipliers - prior
        stored = row[points] >= 0
        rows = row[points[stored]]
        corrections[rows, :-1] = correction[stored]
        corrections[rows, -1] = growth.is_smooth(correction[stored])
        unsolved = solution.distance > problem.tolerance
        return points[unsolved], solution.multipliers[unsolved], prior[unsolved]

    rounds = strides(lattice.dim)
    for number, stride in enumerate(rounds):
        # Of every stride-th node, those that no coarser round has had; the seeds come
        # first.
        _, points = lattice.thinned(stride)
        points = np.union1d(points, seeds) if number == 0 else points
        points = points[waiting[points]]
        waiting[points] = False
        level, numbers = lattice.thinned(rounds[max(number - 1, 0)])
        known = np.where((row[numbers] >= 0)[:, None], corrections[row[numbers]], 0)
        unsolved = [(points[:0], growth.multipliers[:0], growth.multipliers[:0])]
        for block in blocks(len(points), BLOCK_POINTS):
            # From p₀ + R δ, with the correction δ of the nodes around, to the spectrum
            # of the colour nearest to p₀.
            trial = points[block]
            prior = expected(trial, nodes.goal(trial))
            sums = weighted_sum(known, *level.corners(lattice.target(trial)))
            smooth = (sums[:, -1:] > ALL) & ~seeded[trial, None]
            start = prior + np.where(smooth, sums[:, :-1], 0)
            unsolved.append(fit(trial, start, prior, number, max_passes=1))
        # What the first pass leaves is fitted at the end of the round, all at once.
        points, start, prior = (
            np.concatenate(parts) for parts in zip(*unsolved, strict=True)
        )
        fit(points, start, prior, number, MAX_PASSES)
    retry(growth, len(rounds))
    return growth
