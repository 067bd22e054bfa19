"""The constants of a fit: model, lattice, threshold, and the points to be fitted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.fit.solve import Solution, solve
from uplift.fit.unrealisable import NONE, Unrealisable
from uplift.lattice import Lattice
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap


class Method(Protocol):
    """Solves many problems: the interface of `uplift.fit.solve.solve`."""

    def __call__(
        self,
        model: Model,
        forward: ForwardMap,
        start: Array,
        target: Array,
        *,
        tolerance: float,
        max_passes: int,
        prior: Array | None = None,
    ) -> Solution:
        """Solve for multipliers that have given colours; see `uplift.fit.solve.solve`."""
        ...


NO_LATTICE = Lattice(np.array([0.0, 1.0]))
"""Lattice of problems that are solved for given colours only."""


def solver_tolerance(threshold: float) -> float:
    """Return the residual at which the solver stops: the last steps converge quadratically and cost little.

    Parameters
    ----------
    threshold : float
        Largest fitting distance of a fitted point.

    Returns
    -------
    float
        Residual in linear RGB.
    """
    return threshold / 100


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """The problem of fitting lattice points.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to the RGB of the sensor.
    lattice : Lattice
        The lattice.
    threshold : float, default 1e-4
        Largest fitting distance, in linear RGB, of a fitted point.
    unrealisable : Unrealisable, optional
        Points that are fitted to another colour than their target.
    active_points : ndarray of int, shape (k,), optional
        Numbers of the points to be fitted, ascending. All points by default.
    method : callable, default `uplift.fit.solve.solve`
        `uplift.fit.solve.solve`, or a `StockSolver`.
    """

    model: Model
    forward: ForwardMap
    lattice: Lattice
    threshold: float = 1e-4
    unrealisable: Unrealisable = NONE
    active_points: Indices | None = None
    method: Method = solve

    @cached_property
    def points(self) -> Indices:
        """Numbers of the points to be fitted, ascending."""
        return np.arange(self.lattice.size) if self.active_points is None else self.active_points

    @property
    def absent(self) -> Mask:
        """(dim³,) True for points that are not to be fitted."""
        absent = np.ones(self.lattice.size, dtype=bool)
        absent[self.points] = False
        return absent

    @property
    def tolerance(self) -> float:
        """Residual at which the solver stops."""
        return solver_tolerance(self.threshold)

    def goal(self, points: Indices) -> Array:
        """Return the colours that points are fitted to.

        Parameters
        ----------
        points : ndarray of int, shape (k,)
            Point numbers.

        Returns
        -------
        ndarray, shape (k, 3)
            Linear RGB: the target or, for unrealisable points, the nearest realisable colour.
        """
        goal = self.lattice.target(points)
        row = np.searchsorted(self.unrealisable.points, points)
        found = np.append(self.unrealisable.points, -1)[row] == points
        goal[found] = self.unrealisable.nearest[row[found]]
        return goal

    def solve(self, target: Array, start: Array, max_passes: int, prior: Array | None = None) -> Solution:
        """Solve for multipliers that have given colours.

        Parameters
        ----------
        target : ndarray, shape (k, 3)
            Linear RGB.
        start : ndarray, shape (k, C)
            Multipliers to start from.
        max_passes : int
            Limit of the number of passes.
        prior : ndarray, shape (k, C), optional
            Multipliers to change least. By default each step changes the current ones least.

        Returns
        -------
        Solution
            Multipliers and their distances.
        """
        return self.method(
            self.model,
            self.forward,
            start,
            target,
            tolerance=self.tolerance,
            max_passes=max_passes,
            prior=prior,
        )
