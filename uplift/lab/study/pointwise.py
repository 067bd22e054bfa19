"""A lattice fitted a point at a time by scipy's least squares, in moments or in multipliers.

Tódová 2020, 3.1.2 and 3.1.3: numeric differences, three residuals, growing from the middle, every point from the
unknowns of a fitted neighbour. The thesis solves in moments c; the same in multipliers p shows what these buy.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lattice import Lattice
from uplift.models import Model

OUTSIDE = 1.0
"""Residual of numbers that are not the moments of any reflectance: farther than any colour that counts."""
STEP = 1e-6
"""Half the way between the two ends of a difference."""
EVALUATIONS = 24
"""From one start, derivatives aside; twice as many take twice the time and fit few points more."""
LEAST = 1e-15
"""The tolerances of scipy, so low that none of them ends a solve: gradients vanish near black and white."""

IN_MOMENTS, IN_MULTIPLIERS = "in c", "in p"


@dataclass(frozen=True, eq=False)
class PointwiseProblem:
    """Residuals of one colour in ``unknowns``: `IN_MOMENTS` or `IN_MULTIPLIERS`."""

    model: Model
    sensor: Sensor
    unknowns: str

    @cached_property
    def basis(self) -> Array:
        return self.model.basis(self.sensor.wavelengths)

    @property
    def grey(self) -> Array:
        """(C,) unknowns of reflectance one half."""
        flat = np.zeros(self.model.count)
        return self.model.to_storage(flat) if self.unknowns == IN_MOMENTS else flat

    def rgb(self, x: Array) -> Array:
        """Linear RGB (n, 3) of unknowns (n, C). Raises `UpliftError` where some are no reflectance's moments."""
        multipliers = self.model.from_storage(x) if self.unknowns == IN_MOMENTS else x
        return self.sensor.rgb(self.model.squash(multipliers @ self.basis.T))

    def miss(self, x: Array, rgb: Array) -> Array:
        """Colour of unknowns (C,) minus linear RGB (3,)."""
        try:
            return np.asarray(self.rgb(x[None])[0] - rgb)
        except UpliftError:
            return np.full(3, OUTSIDE)

    def differences(self, x: Array, rgb: Array) -> Array:
        """Central differences (3, C) of the residuals.

        Raises
        ------
        StuckError : an end of one lies outside the moments of reflectances, where there is nothing to differ from.
        """
        step = STEP * np.eye(self.model.count)
        try:
            ends = self.rgb(np.concatenate([x + step, x - step]))
        except UpliftError as error:
            raise NoDerivativeError(x) from error
        return np.asarray((ends[: len(x)] - ends[len(x) :]).T / (2 * STEP))

    def solve(self, rgb: Array, start: Array) -> Array:
        """Unknowns (C,) for linear RGB (3,), or where the solver gave up."""
        from scipy.optimize import least_squares

        try:
            found = least_squares(
                self.miss,
                start,
                self.differences,
                args=(rgb,),
                max_nfev=EVALUATIONS,
                ftol=LEAST,
                xtol=LEAST,
                gtol=LEAST,
            )
        except NoDerivativeError as stuck:
            return stuck.at
        return np.asarray(found.x)


class NoDerivativeError(UpliftError):
    """The solver cannot take a derivative ``at`` these unknowns (C,)."""

    def __init__(self, at: Array) -> None:
        super().__init__("no derivative")
        self.at = at


@dataclass(frozen=True, eq=False)
class PointwiseFit:
    """Distance (n,), max |linear RGB|, of every lattice point; how many starts, and the longest chain of neighbours."""

    distance: Array
    starts: int
    rounds: int


def fit_pointwise(
    task: PointwiseProblem, lattice: Lattice, threshold: float, progress: ProgressCallback = ignore_progress
) -> PointwiseFit:
    """Fit the lattice from its middle; each fitted point lends its unknowns to neighbours that are not.

    ``progress`` hears how many points are fitted.
    """
    target = lattice.points
    unknowns = np.tile(task.grey, (lattice.size, 1))
    distance = np.full(lattice.size, np.inf)
    rounds = np.zeros(lattice.size, dtype=np.int64)
    middle = int(lattice.index(np.full(3, lattice.dim // 2)))
    starts, fitted = 0, deque[int]()

    def attempt(point: int, start: Array, number: int) -> None:
        nonlocal starts
        starts += 1
        found = task.solve(target[point], start)
        off = float(np.abs(task.miss(found, target[point])).max())
        if off < distance[point]:
            distance[point], unknowns[point] = off, found
        if off <= threshold:
            rounds[point] = number
            fitted.append(point)

    attempt(middle, task.grey, 0)
    while fitted:
        source = fitted.popleft()
        around, inside = lattice.neighbours(np.array([source]))
        for point in around[0][inside[0]].tolist():
            if distance[point] > threshold:
                attempt(point, unknowns[source], int(rounds[source]) + 1)
        progress(Progress("fit", int((distance <= threshold).sum()), lattice.size))
    for point in np.flatnonzero(np.isinf(distance)).tolist():  # no fitted neighbour ever reached these
        attempt(point, task.grey, 0)
    return PointwiseFit(distance, starts, int(rounds.max()))
