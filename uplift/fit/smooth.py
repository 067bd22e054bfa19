"""Smooth spectra for colours that no measurement constrains; dark where the colour is dark.

Multipliers have no upper bound on slope: from them alone, a dark red rises to a reflectance of 1 outside the range of
the colour-matching functions. So a colour x starts from a brighter one, x' = x / k with k = √max(x). It is solved from
a grey by minimum-norm steps, and its spectrum is scaled by k (docs/mathematics.md, 7; measurements in
docs/fidelity.md).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.base import Base
from uplift.fit.quadrature_jit import COMPILED
from uplift.fit.solve import solve
from uplift.fit.unrealisable import NONE, Unrealisable
from uplift.lattice import Lattice, weighted_sum
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap

BRIGHTENING = 0.5
"""Power of max(x) that a colour is divided by: 0 leaves it unchanged, 1 makes it as bright as possible."""
GREY = 2 / 3
"""Power of the mean of x' that gives the reflectance of the grey to start from."""
TABLE = Lattice(np.linspace(0, 1, 17) ** 2)
MIN_LEVEL = 1e-4
MAX_LEVEL = 0.98
NO_FREEDOM = 3
"""Number of coefficients that the colour alone determines."""


@dataclass(frozen=True, eq=False)
class Smooth(Base):
    """Start of a fit without measurements.

    Parameters
    ----------
    model : Model
        Spectrum model.
    table : Lattice
        Lattice of brightened colours.
    nodes : ndarray, shape (17³, C), optional
        Coefficients at the points of the table; None where no table is needed.
    brightening, grey : float
        Powers, see `BRIGHTENING` and `GREY`.
    """

    model: Model
    table: Lattice
    nodes: Array | None
    brightening: float = BRIGHTENING
    grey: float = GREY

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) of nearly the colours (n, 3), linear RGB in [0, 1], for the solver to finish."""
        return self.model.from_storage(self.coefficients(rgb))

    def coefficients(self, rgb: Array) -> Array:
        """Coefficients (n, C) of nearly the colours (n, 3), linear RGB in [0, 1]; see `Base`."""
        if self.nodes is None:
            return self.model.to_storage(_grey(self.model, rgb, self.grey))
        factor = np.maximum(rgb.max(axis=1), MIN_LEVEL)[:, None] ** self.brightening
        bright = weighted_sum(self.nodes, *self.table.corners(np.minimum(rgb / factor, 1)))
        return factor * bright


def smooth(
    model: Model,
    forward: ForwardMap,
    brightening: float = BRIGHTENING,
    grey: float = GREY,
    outside: Unrealisable = NONE,
) -> Smooth:
    """Solve the table: brightened colours, each from its grey.

    Unrealisable points of the table (``outside``) are solved for the nearest realisable colours: their own multipliers
    would be arbitrary, and would spoil the interpolation between points.
    """
    if model.count == NO_FREEDOM:
        return Smooth(model, TABLE, None, brightening, grey)
    goal = TABLE.points.copy()
    goal[outside.points] = outside.nearest
    found = solve(model, forward, _grey(model, goal, grey), goal, tolerance=1e-5, max_passes=8)
    return Smooth(model, TABLE, model.to_storage(found.multipliers, COMPILED), brightening, grey)


def _grey(model: Model, rgb: Array, power: float) -> Array:
    level = np.clip(rgb.mean(axis=1) ** power, MIN_LEVEL, MAX_LEVEL)
    return model.unsquash(level)[:, None] * model.constant()
