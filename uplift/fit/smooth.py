"""The spectrum a colour gets where no measurement has a say: smooth, and dark where the colour is dark.

Multipliers know no end of slope: from them alone, a dark red rises to a reflectance of 1 as soon as the eye stops
seeing it. So a colour x starts from a brighter one, x' = x / k with k = √max(x), solved from a grey by steps of
least change, its spectrum dimmed by k (docs/mathematics.md, 7; docs/fidelity.md has the measurements).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.quadrature_jit import quadrature_jit
from uplift.fit.solve import solve
from uplift.fit.unrealisable import NONE, Unrealisable
from uplift.lattice import Lattice, weighted_sum
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap

BRIGHTENING = 0.5
"""Power of max(x) that a colour is divided by: 0 leaves it as it is, 1 makes it as bright as can be."""
GREY = 2 / 3
"""Power of the mean of x' that is the reflectance of the grey to start from."""
TABLE = Lattice(np.linspace(0, 1, 17) ** 2)
DARKEST = 1e-4
LIGHTEST = 0.98
NO_FREEDOM = 3
"""Coefficients that the colour alone determines."""


@dataclass(frozen=True, eq=False)
class Smooth:
    """Multipliers to start from. ``coefficients`` (17³, C) of brightened colours; None where no table is needed."""

    model: Model
    table: Lattice
    coefficients: Array | None
    brightening: float = BRIGHTENING
    grey: float = GREY

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) of linear RGB (n, 3) in [0, 1]: nearly that colour, for the solver to finish."""
        if self.coefficients is None:
            return _grey(self.model, rgb, self.grey)
        factor = np.maximum(rgb.max(axis=1), DARKEST)[:, None] ** self.brightening
        bright = weighted_sum(self.coefficients, *self.table.corners(np.minimum(rgb / factor, 1)))
        return self.model.from_storage(factor * bright)


def smooth(
    model: Model,
    forward: ForwardMap,
    brightening: float = BRIGHTENING,
    grey: float = GREY,
    beyond: Unrealisable = NONE,
) -> Smooth:
    """Solve the table: brightened colours, each from its grey; in place of those ``beyond`` reflectances the nearest.

    Solved for what no reflectance has, multipliers end anywhere, and take what lies between with them.
    """
    if model.count == NO_FREEDOM:
        return Smooth(model, TABLE, None, brightening, grey)
    goal = TABLE.points.copy()
    goal[beyond.points] = beyond.nearest
    found = solve(model, forward, _grey(model, goal, grey), goal, tolerance=1e-5, passes=8)
    return Smooth(model, TABLE, model.to_storage(found.multipliers, quadrature_jit), brightening, grey)


def _grey(model: Model, rgb: Array, power: float) -> Array:
    level = np.clip(rgb.mean(axis=1) ** power, DARKEST, LIGHTEST)
    return model.unsquash(level)[:, None] * model.constant()
