"""The state of growth: the best multipliers of every point so far, and the round in which it was fitted."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.problem import Problem
from uplift.fit.solve import Solution
from uplift.lattice import NOT_FITTED

MAX_PASSES = 24
BLOCK_POINTS = 1 << 15
"""Points processed at a time."""

PointPrior = Callable[[Indices], Array]
"""From points (k,) to the multipliers (k, C) expected there."""


@dataclass(eq=False)
class Growth:
    """Growth over all n lattice points, changed in place round by round.

    Parameters
    ----------
    problem : Problem
        The points and their goals.
    progress : callable
        Called with `Progress` events of the stage ``"fit"``.
    """

    problem: Problem
    progress: ProgressCallback
    multipliers: Array = field(init=False)
    """(n, C) best multipliers so far, 0 at inactive points."""
    distance: Array = field(init=False)
    """(n,) their distance from the goal, infinite at inactive points."""
    rgb: NDArray[np.float32] = field(init=False)
    """(n, 3) their linear RGB."""
    round: NDArray[np.int16] = field(init=False)
    """(n,) round in which the point was fitted, −1 if it was not."""
    steps: int = 0
    """Steps of the solver over all points."""

    def __post_init__(self) -> None:
        size = self.problem.lattice.size
        self.multipliers = np.zeros((size, self.problem.model.count))
        self.distance = np.full(size, np.inf)
        self.rgb = np.zeros((size, 3), dtype=np.float32)
        self.round = np.full(size, NOT_FITTED, dtype=np.int16)

    @property
    def waiting(self) -> Indices:
        """Points that are not fitted, ascending."""
        points = self.problem.points
        return points[self.round[points] == NOT_FITTED]

    def attempt(
        self,
        points: Indices,
        start: Array,
        number: int,
        prior: Array | None = None,
        max_passes: int = MAX_PASSES,
    ) -> Solution:
        """Solve points in a round, and keep what is better than before.

        Parameters
        ----------
        points : ndarray of int, shape (k,)
            Point numbers.
        start : ndarray, shape (k, C)
            Multipliers to start from.
        number : int
            The round.
        prior : ndarray, shape (k, C), optional
            Multipliers to change least. By default each step changes the current ones least.
        max_passes : int, default 24
            Limit of the number of passes of the solver.

        Returns
        -------
        Solution
            What the solver found.
        """
        goal = self.problem.goal(points)
        found = self.problem.solve(goal, start, max_passes, prior)
        distance = found.distance
        better = distance < self.distance[points]
        kept = points[better]
        self.multipliers[kept], self.distance[kept] = found.multipliers[better], distance[better]
        self.rgb[kept] = (goal - found.residual)[better]
        self.steps += int(found.steps.sum())
        fitted = (self.round[points] == NOT_FITTED) & (distance <= self.problem.threshold)
        self.round[points[fitted]] = number
        return found

    def report(self, number: int, tried: int) -> None:
        """Report a round, or a block of it, with the number of points tried."""
        fitted = int((self.round != NOT_FITTED).sum())
        detail = f"round {number}: {tried} tried"
        self.progress(Progress("fit", fitted, len(self.problem.points), step=number, detail=detail))


def blocks(points: Indices) -> Iterator[Indices]:
    """Split points into blocks of at most `BLOCK_POINTS`."""
    for first in range(0, len(points), BLOCK_POINTS):
        yield points[first : first + BLOCK_POINTS]
