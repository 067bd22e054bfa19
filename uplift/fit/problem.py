"""What is to be fitted, and how well: the constants of a whole fit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.fit.solve import Solution, solve
from uplift.fit.unrealisable import NONE, Unrealisable
from uplift.lattice import Lattice
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap


@dataclass(frozen=True, eq=False)
class Problem:
    """A model and its forward map, the lattice, and the largest |linear RGB| a point may miss its goal by.

    ``wanted`` (k,), ascending, are the points to be fitted; None for all.
    """

    model: Model
    forward: ForwardMap
    lattice: Lattice
    threshold: float = 1e-4
    beyond: Unrealisable = NONE
    wanted: Indices | None = None

    @cached_property
    def points(self) -> Indices:
        """Numbers of the points to be fitted, ascending."""
        return np.arange(self.lattice.size) if self.wanted is None else self.wanted

    @property
    def absent(self) -> Mask:
        """(dim³,) which points are not to be fitted."""
        absent = np.ones(self.lattice.size, dtype=bool)
        absent[self.points] = False
        return absent

    @property
    def tolerance(self) -> float:
        """What the solver goes on to: the last steps converge quadratically and cost little."""
        return self.threshold / 100

    def goal(self, points: Indices) -> Array:
        """Linear RGB (k, 3) to fit points (k,) to: their targets or, where no reflectance has those, the nearest."""
        goal = self.lattice.target(points)
        place = np.searchsorted(self.beyond.points, points)
        found = np.append(self.beyond.points, -1)[place] == points
        goal[found] = self.beyond.nearest[place[found]]
        return goal

    def solve(self, target: Array, start: Array, passes: int) -> Solution:
        """Multipliers ``start`` (k, C) moved to linear RGB ``target`` (k, 3)."""
        return solve(self.model, self.forward, start, target, tolerance=self.tolerance, passes=passes)
