"""Growth: nodes are fitted in rounds, each from what earlier rounds found (docs/mathematics.md, 7; docs/accuracy.md).

Rounds go from a coarse lattice to finer ones. The answer at a node is the spectrum of its colour that is nearest to its
prior. The correction between prior and answer is smooth over the lattice: a node starts from its prior plus the
correction interpolated from earlier rounds, and one step then does what two did. The answer does not depend on the
start. Nodes that fail are tried again from the mean of their fitted neighbours.

`uplift.fit.growth_thesis` grows outward from seeds instead, as Tódová 2020 does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.problem import Nodes, Problem
from uplift.fit.solver import Solution
from uplift.lattice import NOT_FITTED, Lattice, weighted_sum
from uplift.models.arithmetic import blocked_matmul

MAX_PASSES = 24
BLOCK_POINTS = 1 << 15
"""Nodes processed at a time."""
MIN_CELLS = 4
"""Cells along each axis of the coarsest lattice, at least."""
MAX_CORRECTION = 0.1
"""Largest correction, in units of the metric, that is interpolated: nearly box-shaped spectra have larger ones, which
are not smooth."""
ALL = 1 - 1e-9
"""Sum of the weights of known corners above which all corners are known."""
Expected = Callable[[Indices], Array]
"""From nodes (k,) to the multipliers (k, C) expected there."""


@dataclass(eq=False)
class Growth:
    """State of growth over all n nodes of a lattice, changed in place round by round."""

    problem: Problem
    nodes: Nodes
    progress: ProgressCallback
    multipliers: Array = field(init=False)
    """(n, C) best multipliers so far, 0 at nodes that are not to be fitted."""
    distance: Array = field(init=False)
    """(n,) their distance from the goal, infinite at nodes that are not to be fitted."""
    rgb: NDArray[np.float32] = field(init=False)
    """(n, 3) their linear RGB."""
    round: NDArray[np.int16] = field(init=False)
    """(n,) round in which the node was fitted, −1 if it was not."""

    def __post_init__(self) -> None:
        size = self.nodes.lattice.size
        self.multipliers = np.zeros((size, self.problem.model.count))
        self.distance = np.full(size, np.inf)
        self.rgb = np.zeros((size, 3), dtype=np.float32)
        self.round = np.full(size, NOT_FITTED, dtype=np.int16)

    @property
    def waiting(self) -> Indices:
        """Nodes that are not fitted, ascending."""
        points = self.nodes.points
        return points[self.round[points] == NOT_FITTED]

    def attempt(
        self, points: Indices, start: Array, number: int, prior: Array | None = None, max_passes: int = MAX_PASSES
    ) -> Solution:
        """Solve nodes (k,) from multipliers (k, C) in round ``number``, and keep what is better than before."""
        goal = self.nodes.goal(points)
        solution = self.problem.solve(goal, start, max_passes, prior)
        distance = solution.distance
        better = distance < self.distance[points]
        kept = points[better]
        self.multipliers[kept], self.distance[kept] = solution.multipliers[better], distance[better]
        self.rgb[kept] = (goal - solution.residual)[better]
        fitted = (self.round[points] == NOT_FITTED) & (distance <= self.problem.threshold)
        self.round[points[fitted]] = number
        return solution

    def report(self, number: int, tried: int) -> None:
        """Report a round, or a block of it, with the number of nodes tried."""
        fitted = int((self.round != NOT_FITTED).sum())
        detail = f"round {number}: {tried} tried"
        self.progress(Progress("fit", fitted, len(self.nodes.points), step=number, detail=detail))


def blocks(points: Indices) -> Iterator[Indices]:
    """Split nodes into blocks of at most `BLOCK_POINTS`."""
    for first in range(0, len(points), BLOCK_POINTS):
        yield points[first : first + BLOCK_POINTS]


def strides(dim: int) -> list[int]:
    """Lattice steps between the nodes of each round: powers of two down to 1."""
    return [1 << power for power in reversed(range(max((dim // MIN_CELLS).bit_length(), 1)))]


def grow_from_prior(
    problem: Problem, nodes: Nodes, expected: Expected, seeds: Indices, progress: ProgressCallback
) -> Growth:
    """Fit nodes from the prior. Seeds (S,) are fitted in the first round, and give and take no correction."""
    growth, corrections = Growth(problem, nodes, progress), _Corrections(problem, nodes.lattice, seeds)
    waiting = mask_of(nodes.lattice, nodes.points)
    rounds = strides(nodes.lattice.dim)
    for number, stride in enumerate(rounds):
        # Of every stride-th node, those that no coarser round has had; the seeds come first.
        _, points = nodes.lattice.thinned(stride)
        points = np.union1d(points, seeds) if number == 0 else points
        points = points[waiting[points]]
        waiting[points] = False
        correction = corrections.interpolator(rounds[number - 1]) if number else None
        _fit_round(growth, points, number, expected, correction, corrections)
    _retry(growth, len(rounds))
    return growth


def supporting_points(lattice: Lattice, points: Indices) -> Indices:
    """Return nodes (k,), and those of earlier rounds that their corrections are interpolated from, ascending.

    Fitted alone, they have the answers of the lattice with all nodes.
    """
    wanted, finer = mask_of(lattice, points), np.ones(lattice.size, dtype=bool)
    for stride in reversed(strides(lattice.dim)[:-1]):
        level, numbers = lattice.thinned(stride)
        coarser = mask_of(lattice, numbers)
        for block in blocks(np.flatnonzero(wanted & finer & ~coarser)):
            corners, weights = level.corners(lattice.target(block))
            wanted[numbers[corners[weights > 0]]] = True
        finer = coarser
    return np.flatnonzero(wanted)


class _Corrections:
    """Corrections, multipliers found minus those expected, at every second node of a lattice, where known."""

    def __init__(self, problem: Problem, lattice: Lattice, seeds: Indices) -> None:
        self._lattice, self._seeded = lattice, mask_of(lattice, seeds)
        self._to_metric = problem.forward.inverse_root.T
        half, halves = lattice.thinned(2)
        self._row = np.full(lattice.size, -1, dtype=np.int32)
        self._row[halves] = np.arange(len(halves))
        self._row[seeds] = -1
        self._table = np.zeros((half.size, problem.model.count + 1))

    def record(self, points: Indices, correction: Array) -> None:
        """Store the corrections (k, C) of nodes, unless they are too large."""
        rows = self._row[points]
        rows, correction = rows[rows >= 0], correction[rows >= 0]
        # |R⁻¹ (p − p₀)|∞; the last column is the weight of a known correction.
        size = np.abs(blocked_matmul(correction, self._to_metric)).max(axis=1)
        self._table[rows, :-1], self._table[rows, -1] = correction, size <= MAX_CORRECTION

    def interpolator(self, stride: int) -> Callable[[Indices], Array]:
        """Return the trilinear interpolation between every ``stride``-th node, 0 where a corner is not known."""
        level, points = self._lattice.thinned(stride)
        rows = self._row[points]
        table = np.where((rows >= 0)[:, None], self._table[rows], 0)

        def interpolate(points: Indices) -> Array:
            sums = weighted_sum(table, *level.corners(self._lattice.target(points)))
            known = (sums[:, -1:] > ALL) & ~self._seeded[points, None]
            return np.where(known, sums[:, :-1], 0)

        return interpolate


def _fit_round(
    growth: Growth,
    points: Indices,
    number: int,
    expected: Expected,
    correction: Callable[[Indices], Array] | None,
    corrections: _Corrections,
) -> None:
    """Fit nodes from their prior and correction. What the first pass leaves is fitted at the end, all at once."""
    rest = [(points[:0], growth.multipliers[:0], growth.multipliers[:0])]
    for block in blocks(points):
        # From p₀ + R δ, with the correction δ of the nodes around, to the spectrum of the colour nearest to p₀.
        prior = expected(block)
        start = prior + (0.0 if correction is None else correction(block))
        solution = growth.attempt(block, start, number, prior, max_passes=1)
        corrections.record(block, solution.multipliers - prior)
        unsolved = solution.distance > growth.problem.tolerance
        rest.append((block[unsolved], solution.multipliers[unsolved], prior[unsolved]))
        growth.report(number, len(block))
    points, start, prior = (np.concatenate(parts) for parts in zip(*rest, strict=True))
    if points.size:
        solution = growth.attempt(points, start, number, prior)
        corrections.record(points, solution.multipliers - prior)
        growth.report(number, len(points))


def _retry(growth: Growth, number: int) -> None:
    """Try failed nodes again, as long as another of their neighbours has been fitted."""
    fresh = np.flatnonzero(growth.round != NOT_FITTED)
    while fresh.size:
        points, means = _frontier(growth, fresh)
        if not points.size:
            break
        solution = growth.attempt(points, means, number)
        fresh = points[solution.distance <= growth.problem.threshold]
        growth.report(number, len(points))
        number += 1


def _frontier(growth: Growth, fresh: Indices) -> tuple[Indices, Array]:
    """The waiting neighbours of freshly fitted nodes, and the mean multipliers of their own fitted neighbours."""
    lattice, multipliers = growth.nodes.lattice, growth.multipliers
    fitted, is_fresh = growth.round != NOT_FITTED, mask_of(lattice, fresh)
    points, means = [fresh[:0]], [multipliers[:0]]
    for block in blocks(growth.waiting):
        neighbours, inside = lattice.neighbours(block)
        adjacent = (inside & is_fresh[neighbours]).any(axis=1)
        neighbours, inside = neighbours[adjacent], inside[adjacent]
        known = inside & fitted[neighbours]
        # Mean over the fitted neighbours, column by column: all 26 at once would take 26 times the memory.
        total = np.zeros((len(neighbours), multipliers.shape[1]))
        for column in range(neighbours.shape[1]):
            total += np.where(known[:, column, None], multipliers[neighbours[:, column]], 0)
        points.append(block[adjacent])
        means.append(total / np.maximum(known.sum(axis=1), 1)[:, None])
    return np.concatenate(points), np.concatenate(means)


def mask_of(lattice: Lattice, points: Indices) -> Mask:
    """Mark nodes among all (dim³,)."""
    mask = np.zeros(lattice.size, dtype=bool)
    mask[points] = True
    return mask
