"""Growth from the prior, in rounds from a coarse lattice to finer ones.

The answer at a point is the spectrum of its colour that is nearest to its prior. The correction between prior and
answer is smooth over the lattice: a point starts from its prior plus the correction interpolated from the points of
earlier rounds, and one step then does what two did (docs/performance.md). The answer does not depend on the start.
Points that fail are tried again from the mean of their fitted neighbours.

`uplift.fit.grow_from_neighbours` grows outward from seeds, as Tódová 2020 does.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import Growth, PointPrior, blocks
from uplift.fit.problem import Problem
from uplift.lattice import NOT_FITTED, Lattice, weighted_sum
from uplift.models.matmul import matmul_rows

MIN_CELLS = 4
"""Cells along each axis of the coarsest lattice, at least."""
MAX_CORRECTION = 0.1
"""Largest correction, in units of the metric, that is interpolated: nearly box-shaped spectra have larger ones, which
are not smooth."""
ALL = 1 - 1e-9
"""Sum of the weights of known corners above which all corners are known."""


def grow_from_prior(problem: Problem, prior: PointPrior, seeds: Indices, progress: ProgressCallback) -> Growth:
    """Fit all active points of a problem.

    Parameters
    ----------
    problem : Problem
        The points and their goals.
    prior : callable
        Multipliers expected at points.
    seeds : ndarray of int, shape (S,)
        Points whose prior is an atlas entry. They are fitted in the first round, and give and take no correction.
    progress : callable
        Called with `Progress` events of the stage ``"fit"``.

    Returns
    -------
    Growth
        Multipliers, distances and rounds.
    """
    growth, corrections = Growth(problem, progress), Corrections(problem, seeds)
    waiting = _mask(problem.lattice, problem.points)
    steps = strides(problem.lattice.dim)
    for number, stride in enumerate(steps):
        _, points = problem.lattice.thinned(stride)
        points = np.union1d(points, seeds) if number == 0 else points
        points = points[waiting[points]]
        waiting[points] = False
        correction = corrections.between(steps[number - 1]) if number else _no_correction
        _fit_round(growth, points, number, prior, correction, corrections)
    _retry(growth, len(steps))
    return growth


def strides(dim: int) -> list[int]:
    """Return the lattice steps between the points of each round: powers of two down to 1."""
    return [1 << power for power in reversed(range(max((dim // MIN_CELLS).bit_length(), 1)))]


def supporting_points(lattice: Lattice, points: Indices) -> Indices:
    """Return points, and those of earlier rounds that their corrections are interpolated from.

    Parameters
    ----------
    lattice : Lattice
        The lattice.
    points : ndarray of int, shape (k,)
        Point numbers.

    Returns
    -------
    ndarray of int, shape (m,)
        Point numbers, ascending. Fitted alone, they have the answers of the whole lattice.
    """
    wanted, finer = _mask(lattice, points), np.ones(lattice.size, dtype=bool)
    for stride in reversed(strides(lattice.dim)[:-1]):
        level, numbers = lattice.thinned(stride)
        coarser = _mask(lattice, numbers)
        for block in blocks(np.flatnonzero(wanted & finer & ~coarser)):
            corners, weights = level.corners(lattice.target(block))
            wanted[numbers[corners[weights > 0]]] = True
        finer = coarser
    return np.flatnonzero(wanted)


Correction = Callable[[Indices], Array | float]
"""From points (k,) to the corrections (k, C) expected there."""


def _no_correction(points: Indices) -> float:
    return 0.0


def _fit_round(
    growth: Growth,
    points: Indices,
    number: int,
    prior: PointPrior,
    correction: Correction,
    corrections: Corrections,
) -> None:
    """Fit points from their prior and correction. What the first pass leaves is fitted at the end, all at once."""
    rest = [(points[:0], growth.multipliers[:0], growth.multipliers[:0])]
    for block in blocks(points):
        expected = prior(block)
        found = growth.attempt(block, expected + correction(block), number, expected, max_passes=1)
        corrections.record(block, found.multipliers - expected)
        unsolved = found.distance > growth.problem.tolerance
        rest.append((block[unsolved], found.multipliers[unsolved], expected[unsolved]))
        growth.report(number, len(block))
    points, start, expected = (np.concatenate(parts) for parts in zip(*rest, strict=True))
    if points.size:
        found = growth.attempt(points, start, number, expected)
        corrections.record(points, found.multipliers - expected)
        growth.report(number, len(points))


class Corrections:
    """Corrections at the points of every second node, where known.

    Parameters
    ----------
    problem : Problem
        The points.
    seeds : ndarray of int, shape (S,)
        Points that give and take no correction.
    """

    def __init__(self, problem: Problem, seeds: Indices) -> None:
        self._lattice, self._seeded = problem.lattice, _mask(problem.lattice, seeds)
        self._to_metric = problem.forward.inverse_root.T
        self._half, halves = problem.lattice.thinned(2)
        self._row = np.full(problem.lattice.size, -1, dtype=np.int32)
        self._row[halves] = np.arange(len(halves))
        self._row[seeds] = -1
        self._table = np.zeros((self._half.size, problem.model.count + 1))

    def record(self, points: Indices, correction: Array) -> None:
        """Store the corrections (k, C) of points on every second node, unless they are too large."""
        rows = self._row[points]
        rows, correction = rows[rows >= 0], correction[rows >= 0]
        size = np.abs(matmul_rows(correction, self._to_metric)).max(axis=1)
        self._table[rows, :-1], self._table[rows, -1] = correction, size <= MAX_CORRECTION

    def between(self, stride: int) -> Correction:
        """Return the trilinear interpolation between every ``stride``-th node, 0 where a corner is not known."""
        level, points = self._lattice.thinned(stride)
        rows = self._row[points]
        table = np.where((rows >= 0)[:, None], self._table[rows], 0)

        def interpolate(points: Indices) -> Array:
            sums = weighted_sum(table, *level.corners(self._lattice.target(points)))
            known = (sums[:, -1:] > ALL) & ~self._seeded[points, None]
            return np.where(known, sums[:, :-1], 0)

        return interpolate


def _mask(lattice: Lattice, points: Indices) -> Mask:
    mask = np.zeros(lattice.size, dtype=bool)
    mask[points] = True
    return mask


def _retry(growth: Growth, number: int) -> None:
    """Try failed points again, as long as another of their neighbours has been fitted."""
    fresh = np.flatnonzero(growth.round != NOT_FITTED)
    while fresh.size:
        points, means = _frontier(growth, fresh)
        if not points.size:
            break
        found = growth.attempt(points, means, number)
        fresh = points[found.distance <= growth.problem.threshold]
        growth.report(number, len(points))
        number += 1


def _frontier(growth: Growth, fresh: Indices) -> tuple[Indices, Array]:
    """The waiting neighbours of freshly fitted points, and the mean multipliers of their own fitted neighbours."""
    lattice, multipliers = growth.problem.lattice, growth.multipliers
    fitted, is_fresh = growth.round != NOT_FITTED, _mask(lattice, fresh)
    points, means = [fresh[:0]], [multipliers[:0]]
    for block in blocks(growth.waiting):
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
