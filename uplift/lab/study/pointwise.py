"""Lattice fit one point at a time by scipy's least squares, in moments or in multipliers.

Tódová 2020, *Constrained Spectral Uplifting*, sections 3.1.2 and 3.1.3: numeric differences, three residuals, and
growth from the middle of the lattice. Each point starts from the unknowns of a fitted neighbour. The thesis solves for
moments c. The same method for multipliers p shows the benefit of these.
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

INFEASIBLE_RESIDUAL = 1.0
"""Residual of numbers that are not the moments of a reflectance: farther than any colour of interest."""
STEP = 1e-6
"""Step of the central differences."""
EVALUATIONS = 24
"""Limit per start, without those of derivatives. Twice as many take twice the time and fit few more points."""
TOLERANCE = 1e-15
"""Tolerances of scipy, too small to end a solve: gradients vanish near black and white."""

IN_MOMENTS, IN_MULTIPLIERS = "in c", "in p"
"""Unknowns of a `PointwiseProblem`."""


class NoDerivativeError(UpliftError):
    """A difference at the unknowns ``at`` (C,) would leave the moments of reflectances."""

    def __init__(self, at: Array) -> None:
        super().__init__("the residuals have no derivative", code="no-derivative", hint="start elsewhere")
        self.at = at


@dataclass(frozen=True, eq=False)
class PointwiseProblem:
    """Least-squares problem of one colour.

    ``model``: spectrum model with C coefficients.
    ``sensor``: sensor that the colour refers to.
    ``unknowns``: `IN_MOMENTS` or `IN_MULTIPLIERS`.
    """

    model: Model
    sensor: Sensor
    unknowns: str

    @cached_property
    def basis(self) -> Array:
        """Basis of the model at the wavelengths of the sensor."""
        return self.model.basis(self.sensor.wavelengths)

    @property
    def grey(self) -> Array:
        """Unknowns (C,) of reflectance one half."""
        flat = np.zeros(self.model.count)
        return self.model.to_storage(flat) if self.unknowns == IN_MOMENTS else flat

    def rgb(self, x: Array) -> Array:
        """Linear RGB (n, 3) of unknowns (n, C). Raises `UpliftError` for numbers that are not moments."""
        multipliers = self.model.from_storage(x) if self.unknowns == IN_MOMENTS else x
        return self.sensor.rgb(self.model.squash(multipliers @ self.basis.T))

    def residuals(self, x: Array, rgb: Array) -> Array:
        """Difference (3,) of the colour of unknowns (C,) from linear RGB (3,)."""
        try:
            return np.asarray(self.rgb(x[None])[0] - rgb)
        except UpliftError:
            return np.full(3, INFEASIBLE_RESIDUAL)

    def jacobian(self, x: Array, rgb: Array) -> Array:
        """Central differences (3, C) of the residuals. Raises `NoDerivativeError`."""
        step = STEP * np.eye(self.model.count)
        try:
            ends = self.rgb(np.concatenate([x + step, x - step]))
        except UpliftError as error:
            raise NoDerivativeError(x) from error
        return np.asarray((ends[: len(x)] - ends[len(x) :]).T / (2 * STEP))

    def solve(self, rgb: Array, start: Array) -> Array:
        """Find unknowns (C,) for linear RGB (3,); without convergence, return those of the last iteration."""
        from scipy.optimize import least_squares

        try:
            solution = least_squares(
                self.residuals,
                start,
                self.jacobian,
                args=(rgb,),
                max_nfev=EVALUATIONS,
                ftol=TOLERANCE,
                xtol=TOLERANCE,
                gtol=TOLERANCE,
            )
        except NoDerivativeError as error:
            return error.at
        return np.asarray(solution.x)


@dataclass(frozen=True, eq=False)
class PointwiseFit:
    """Result of `fit_pointwise`.

    ``distance`` (n,): largest difference in linear RGB at each lattice point.
    ``starts``: number of solves.
    ``rounds``: length of the longest chain of neighbours.
    """

    distance: Array
    starts: int
    rounds: int


def fit_pointwise(
    problem: PointwiseProblem,
    lattice: Lattice,
    threshold: float,
    progress: ProgressCallback = ignore_progress,
) -> PointwiseFit:
    """Fit the lattice from its middle; each fitted point starts its unfitted neighbours from its own unknowns."""
    target = lattice.points
    unknowns = np.tile(problem.grey, (lattice.size, 1))
    distance = np.full(lattice.size, np.inf)
    rounds = np.zeros(lattice.size, dtype=np.int64)
    starts, fitted = 0, deque[int]()

    def attempt(point: int, start: Array, number: int) -> None:
        nonlocal starts
        starts += 1
        x = problem.solve(target[point], start)
        largest = float(np.abs(problem.residuals(x, target[point])).max())
        if largest < distance[point]:
            distance[point], unknowns[point] = largest, x
        if largest <= threshold:
            rounds[point] = number
            fitted.append(point)

    attempt(int(lattice.index(np.full(3, lattice.dim // 2))), problem.grey, 0)
    while fitted:
        source = fitted.popleft()
        neighbours, inside = lattice.neighbours(np.array([source]))
        for point in neighbours[0][inside[0]].tolist():
            if distance[point] > threshold:
                attempt(point, unknowns[source], int(rounds[source]) + 1)
        progress(Progress("fit", int((distance <= threshold).sum()), lattice.size))
    for point in np.flatnonzero(np.isinf(distance)).tolist():  # points without a fitted neighbour
        attempt(point, problem.grey, 0)
    return PointwiseFit(distance, starts, int(rounds.max()))
