"""The lattice over RGB: its axis, points, cells and neighbours. Points count with blue fastest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import OptionError

CORNERS = np.array(list(product((0, 1), repeat=3)))
"""(8, 3) steps from a cell's lowest point to its corners."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """dim³ points at every combination of the axis ``nodes`` (dim,): linear RGB, 0 to 1, increasing."""

    nodes: Array

    def __post_init__(self) -> None:
        axis = self.nodes.ndim == 1 and len(self.nodes) >= 2 and bool(np.isfinite(self.nodes).all())
        if not axis or not (np.diff(self.nodes) > 0).all():
            raise OptionError("a lattice needs at least 2 increasing nodes", hint="use --dim 2 or more")

    @property
    def dim(self) -> int:
        return len(self.nodes)

    @property
    def size(self) -> int:
        return self.dim**3

    @cached_property
    def points(self) -> Array:
        """(dim³, 3) target RGB of every point."""
        grid = np.meshgrid(self.nodes, self.nodes, self.nodes, indexing="ij")
        return np.stack(grid, axis=-1).reshape(-1, 3)

    def target(self, index: Indices) -> Array:
        """(…, 3) target RGB of point numbers (…)."""
        return self.nodes[self.position(index)]

    def index(self, position: Indices) -> Indices:
        """Point numbers (…) of positions (…, 3) along the axes."""
        return (position[..., 0] * self.dim + position[..., 1]) * self.dim + position[..., 2]

    def position(self, index: Indices) -> Indices:
        """Positions (…, 3) along the axes of point numbers (…)."""
        return np.stack(np.unravel_index(index, (self.dim,) * 3), axis=-1)

    def steps_along(self, rgb: Array) -> Array:
        """Linear RGB (n, 3) as positions along the axes in steps, with fractions, 0 to dim − 1."""
        return np.interp(rgb, self.nodes, np.arange(self.dim))

    def at_steps(self, steps: Array) -> Array:
        """Linear RGB (n, 3) of positions along the axes in steps; outside the lattice, its edge."""
        return np.interp(steps, np.arange(self.dim), self.nodes)

    def cell(self, rgb: Array) -> tuple[Indices, Array]:
        """Lowest corner (n, 3) and fraction (n, 3) in [0, 1] of the cells that hold linear RGB (n, 3)."""
        low = self.lowest(rgb)
        start = self.nodes[low]
        return low, (rgb - start) / (self.nodes[low + 1] - start)

    def lowest(self, rgb: Array) -> Indices:
        """Positions (n, 3) of the lowest corners of the cells that linear RGB (n, 3) lie in; nearest, of outsiders."""
        return np.clip(np.searchsorted(self.nodes, rgb, side="right") - 1, 0, self.dim - 2)

    def corners(self, rgb: Array) -> tuple[Indices, Array]:
        """Point numbers (n, 8) and trilinear weights (n, 8), summing to 1, around linear RGB (n, 3)."""
        return self.around(*self.cell(rgb))

    def around(self, low: Indices, fraction: Array) -> tuple[Indices, Array]:
        """The same, for the lowest corner (n, 3) and fraction (n, 3) of cells."""
        along = np.ascontiguousarray(fraction.T)
        r, g, b = np.stack([1 - along, along], axis=1)
        weights = (r[:, None, None] * g[None, :, None] * b[None, None, :]).reshape(8, -1)
        return self.index(low)[:, None] + self.index(CORNERS), np.ascontiguousarray(weights.T)

    def corners_of(self, cells: Mask) -> Mask:
        """Which points (dim³,) are corners of ``cells`` (dim³,); a cell has the number of its lowest corner."""
        points = np.zeros((self.dim,) * 3, dtype=bool)
        for r, g, b in CORNERS:
            inside = self._grid(cells)[: self.dim - r, : self.dim - g, : self.dim - b]
            points[r:, g:, b:] |= inside
        return points.ravel()

    def cells_of(self, points: Mask) -> Mask:
        """Which cells (dim³,) have all their corners among ``points`` (dim³,)."""
        cells = np.zeros((self.dim,) * 3, dtype=bool)
        cells[:-1, :-1, :-1] = True
        for r, g, b in CORNERS:
            cells[: self.dim - r, : self.dim - g, : self.dim - b] &= self._grid(points)[r:, g:, b:]
        return cells.ravel()

    def _grid(self, values: Mask) -> Mask:
        return values.reshape((self.dim,) * 3)

    @cached_property
    def steps(self) -> Indices:
        """(26, 3) steps from a point to its neighbours."""
        steps = np.array(list(product((-1, 0, 1), repeat=3)))
        return steps[(steps != 0).any(axis=1)]

    def neighbours(self, index: Indices) -> tuple[Indices, Mask]:
        """Point numbers (n, 26) of the neighbours of points (n,), and which of them exist."""
        position = self.position(index)[:, None, :] + self.steps
        inside: Mask = np.all((position >= 0) & (position < self.dim), axis=-1)
        return self.index(np.clip(position, 0, self.dim - 1)), inside


def weighted_sum(values: Values, points: Indices, weights: Array) -> Values:
    """Rows (n, K) of values (m, K), weighted: points and weights (n, 8)."""
    # Indices are known to be good: "clip" spares the check, and the copy that it would need.
    corners = values.take(points, axis=0, mode="clip")
    return (weights.astype(values.dtype, copy=False)[:, None, :] @ corners)[:, 0, :]
