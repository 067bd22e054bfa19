"""What is fitted: the problem that all stages of a build share, and the nodes of a
lattice with their goals.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry.object_colours import solid, toward_grey
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices, blocks
from uplift.fit.solver import LeastChange, Method, Solution, solve
from uplift.lattice.lattice import CORNERS, Lattice
from uplift.models.minimum_norm import ForwardMap, forward_map
from uplift.models.model import Model

BLOCK_NODES = 1 << 15
"""Nodes that are tested at a time."""
MARGIN = 1e-3
"""Linear RGB between the goals of unrealisable nodes and the boundary. Nearer to it
spectra become boxes, and many of these have the same colour: rounding would decide
between them.
"""


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """Sensor, spectrum model, lights under which colours are kept, light of the errors,
    threshold and solver.

    ``error_light`` is that of the sensor by default. ``threshold`` is the largest
    distance of a fitted node in linear RGB. ``method`` solves batches of nodes; see
    `uplift.fit.solver`.
    """

    sensor: Sensor
    model: Model
    lights: tuple[Light, ...] = ()
    error_light: Light | None = None
    threshold: float = 1e-4
    method: Method = LeastChange

    @cached_property
    def forward(self) -> ForwardMap:
        """Map from multipliers to the RGB of the sensor."""
        return forward_map(self.model, self.sensor.wavelengths, self.sensor.matrix)

    @property
    def light_of_errors(self) -> Light:
        """Light under which errors are learnt and stored."""
        return self.error_light or self.sensor.light

    @property
    def tolerance(self) -> float:
        """Residual at which solvers stop: the last steps converge quadratically and
        cost little.
        """
        return self.threshold / 100

    def solve(
        self, target: Array, start: Array, max_passes: int, prior: Array | None = None
    ) -> Solution:
        """Find multipliers (n, C) of linear RGB (n, 3); see
        `uplift.fit.solver.solve`.
        """
        if self.model.is_determined:
            prior = None  # would only slow the convergence down
        return solve(
            self.forward,
            start,
            target,
            self.tolerance,
            max_passes,
            prior=prior,
            method=self.method,
        )


@dataclass(frozen=True, eq=False, repr=False)
class Nodes:
    """Nodes of a lattice that are to be fitted, by their numbers (k,), ascending.

    ``unrealisable`` are those whose colour no reflectance has, and ``nearest`` (u, 3)
    the linear RGB that replace theirs in the fit: realisable colours of the same hue
    and less chroma (`nodes_of`).
    """

    lattice: Lattice
    points: Indices
    unrealisable: Indices
    nearest: Array

    def goal(self, points: Indices) -> Array:
        """Linear RGB (k, 3) that nodes (k,) are fitted to."""
        goal = self.lattice.target(points)
        row = np.searchsorted(self.unrealisable, points)
        replaced = np.append(self.unrealisable, -1)[row] == points
        goal[replaced] = self.nearest[row[replaced]]
        return goal


def nodes_of(lattice: Lattice, sensor: Sensor, points: Indices | None = None) -> Nodes:
    """Find the goals of nodes, by their numbers, or of all nodes (docs/mathematics.md,
    9).

    The goal of an unrealisable node has its hue and less chroma: it lies on the
    straight line to the grey of the same luminance, `MARGIN` inside the object-colour
    solid. The spectra on the boundary are steps between 0 and 1 (MacAdam 1935), which
    no smooth model has.
    """
    points = np.arange(lattice.size) if points is None else points
    limits = solid(sensor.matrix)
    # Of each block, the colours outside the solid {W g: 0 ≤ g ≤ 1}
    outside = [points[:0]]
    nearest = [np.zeros((0, 3))]
    # The solid is convex: with the corners of RGB it contains everything between them.
    if not limits.contains(CORNERS.astype(float)).all():
        for block in blocks(len(points), BLOCK_NODES):
            numbers = points[block]
            numbers = numbers[~limits.contains(lattice.target(numbers))]
            target = lattice.target(numbers)
            outside.append(numbers)
            nearest.append(toward_grey(limits, sensor.grey(target), target, MARGIN))
    return Nodes(lattice, points, np.concatenate(outside), np.concatenate(nearest))
