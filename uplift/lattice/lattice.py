"""The regular grid over RGB: axis nodes, point numbers, cells and neighbours. Points are numbered blue fastest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import OptionError

CORNERS = np.array(list(product((0, 1), repeat=3)))
"""(8, 3) steps from the lowest corner of a cell to all its corners."""
NEIGHBOURS = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)])
"""(26, 3) steps from a point to its neighbours."""


@dataclass(frozen=True, eq=False, repr=False)
class Lattice:
    """A regular grid of dim³ points over linear RGB.

    A cell is the box between eight neighbouring points; it has the number of its lowest corner.

    Parameters
    ----------
    nodes : ndarray, shape (dim,)
        Coordinates along each axis: linear RGB, strictly increasing, usually from 0 to 1.

    Raises
    ------
    OptionError
        Fewer than two nodes, or nodes that do not increase (``nodes-not-increasing``).

    Examples
    --------
    >>> import numpy as np
    >>> lattice = Lattice(np.linspace(0, 1, 5))
    >>> lattice
    Lattice(dim 5, 0 to 1)
    >>> lattice.points[6].tolist()
    [0.0, 0.25, 0.25]
    """

    nodes: Array

    def __post_init__(self) -> None:
        nodes = self.nodes
        valid = nodes.ndim == 1 and len(nodes) >= 2 and bool(np.isfinite(nodes).all())
        if not valid or not (np.diff(nodes) > 0).all():
            raise OptionError(
                f"the nodes of a lattice must be at least 2 increasing numbers, got shape {nodes.shape}",
                code="nodes-not-increasing",
                hint="use dim=2 or more",
            )

    def __repr__(self) -> str:
        return f"Lattice(dim {self.dim}, {self.nodes[0]:g} to {self.nodes[-1]:g})"

    @property
    def dim(self) -> int:
        """Number of nodes along each axis."""
        return len(self.nodes)

    @property
    def size(self) -> int:
        """Number of points, dim³."""
        return self.dim**3

    @property
    def shape(self) -> tuple[int, int, int]:
        """(dim, dim, dim), the shape of an array over the points."""
        return (self.dim,) * 3

    @cached_property
    def points(self) -> Array:
        """(dim³, 3) target RGB of every point."""
        grid = np.meshgrid(self.nodes, self.nodes, self.nodes, indexing="ij")
        return np.stack(grid, axis=-1).reshape(-1, 3)

    def target(self, index: Indices) -> Array:
        """Return the target RGB of points.

        Parameters
        ----------
        index : ndarray of int, shape (...)
            Point numbers.

        Returns
        -------
        ndarray, shape (..., 3)
            Linear RGB.
        """
        return self.nodes[self.position(index)]

    def index(self, position: Indices) -> Indices:
        """Return point numbers.

        Parameters
        ----------
        position : ndarray of int, shape (..., 3)
            Positions along the axes.

        Returns
        -------
        ndarray of int, shape (...)
            Point numbers.
        """
        return (position[..., 0] * self.dim + position[..., 1]) * self.dim + position[..., 2]

    def position(self, index: Indices) -> Indices:
        """Return positions along the axes, the inverse of `index`.

        Parameters
        ----------
        index : ndarray of int, shape (...)
            Point numbers.

        Returns
        -------
        ndarray of int, shape (..., 3)
            Positions, 0 to dim − 1.
        """
        return np.stack(np.unravel_index(index, self.shape), axis=-1)

    def to_steps(self, rgb: Array) -> Array:
        """Convert linear RGB to fractional positions along the axes.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (n, 3)
            Positions in lattice steps, 0 to dim − 1.
        """
        return np.interp(rgb, self.nodes, np.arange(self.dim))

    def from_steps(self, steps: Array) -> Array:
        """Convert fractional positions to linear RGB, the inverse of `to_steps`.

        Parameters
        ----------
        steps : ndarray, shape (n, 3)
            Positions in lattice steps; outside the lattice its edge is taken.

        Returns
        -------
        ndarray, shape (n, 3)
            Linear RGB.
        """
        return np.interp(steps, np.arange(self.dim), self.nodes)

    def cell(self, rgb: Array) -> tuple[Indices, Array]:
        """Find the cells that contain colours.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB.

        Returns
        -------
        low : ndarray of int, shape (n, 3)
            Position of the lowest corner.
        fraction : ndarray, shape (n, 3)
            Place of the colour within the cell, 0 to 1 along each axis.
        """
        low = self.lowest_corner(rgb)
        start = self.nodes[low]
        return low, (rgb - start) / (self.nodes[low + 1] - start)

    def lowest_corner(self, rgb: Array) -> Indices:
        """Return the lowest corners of the cells that contain colours.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB; colours outside the lattice belong to the nearest cell.

        Returns
        -------
        ndarray of int, shape (n, 3)
            Positions, 0 to dim − 2.
        """
        return np.clip(np.searchsorted(self.nodes, rgb, side="right") - 1, 0, self.dim - 2)

    def corners(self, rgb: Array) -> tuple[Indices, Array]:
        """Return the corners of the cells around colours, with trilinear weights.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB.

        Returns
        -------
        points : ndarray of int, shape (n, 8)
            Point numbers.
        weights : ndarray, shape (n, 8)
            Trilinear weights, summing to 1.
        """
        return self.cell_corners(*self.cell(rgb))

    def cell_corners(self, low: Indices, fraction: Array) -> tuple[Indices, Array]:
        """Return the corners of cells, with the trilinear weights of places within them.

        Parameters
        ----------
        low, fraction : ndarray, shape (n, 3)
            As returned by `cell`.

        Returns
        -------
        points : ndarray of int, shape (n, 8)
            Point numbers.
        weights : ndarray, shape (n, 8)
            Trilinear weights, summing to 1.
        """
        along = np.ascontiguousarray(fraction.T)
        r, g, b = np.stack([1 - along, along], axis=1)
        weights = (r[:, None, None] * g[None, :, None] * b[None, None, :]).reshape(8, -1)
        return self.index(low)[:, None] + self.index(CORNERS), np.ascontiguousarray(weights.T)

    def corner_points(self, cells: Mask) -> Mask:
        """Return the points that are corners of cells.

        Parameters
        ----------
        cells : ndarray of bool, shape (dim³,)
            Mask of cells.

        Returns
        -------
        ndarray of bool, shape (dim³,)
            Mask of points.
        """
        points = np.zeros(self.shape, dtype=bool)
        for r, g, b in CORNERS:
            inside = cells.reshape(self.shape)[: self.dim - r, : self.dim - g, : self.dim - b]
            points[r:, g:, b:] |= inside
        return points.ravel()

    def complete_cells(self, points: Mask) -> Mask:
        """Return the cells whose eight corners are all in a set of points.

        Parameters
        ----------
        points : ndarray of bool, shape (dim³,)
            Mask of points.

        Returns
        -------
        ndarray of bool, shape (dim³,)
            Mask of cells.
        """
        cells = np.zeros(self.shape, dtype=bool)
        cells[:-1, :-1, :-1] = True
        for r, g, b in CORNERS:
            cells[: self.dim - r, : self.dim - g, : self.dim - b] &= points.reshape(self.shape)[r:, g:, b:]
        return cells.ravel()

    def thinned(self, stride: int) -> tuple[Lattice, Indices]:
        """Return the coarser lattice of every ``stride``-th node and the last.

        Parameters
        ----------
        stride : int
            Steps between its nodes, at least 1.

        Returns
        -------
        coarse : Lattice
            The coarser lattice.
        points : ndarray of int, shape (coarse.size,)
            Numbers that its points have in this lattice.
        """
        kept = np.append(np.arange(0, self.dim - 1, stride), self.dim - 1)
        grid = np.meshgrid(kept, kept, kept, indexing="ij")
        return Lattice(self.nodes[kept]), self.index(np.stack(grid, axis=-1).reshape(-1, 3))

    def neighbours(self, index: Indices) -> tuple[Indices, Mask]:
        """Return the neighbours of points, diagonal ones included.

        Parameters
        ----------
        index : ndarray of int, shape (n,)
            Point numbers.

        Returns
        -------
        neighbours : ndarray of int, shape (n, 26)
            Point numbers.
        inside : ndarray of bool, shape (n, 26)
            False for neighbours that would lie outside the lattice.
        """
        position = self.position(index)[:, None, :] + NEIGHBOURS
        inside: Mask = np.all((position >= 0) & (position < self.dim), axis=-1)
        return self.index(np.clip(position, 0, self.dim - 1)), inside


def weighted_sum(values: Values, points: Indices, weights: Array) -> Values:
    """Sum rows of a table by trilinear weights.

    Parameters
    ----------
    values : ndarray, shape (m, K)
        Rows to sum, float32 or float64.
    points : ndarray of int, shape (n, 8)
        Row numbers.
    weights : ndarray, shape (n, 8)
        Weight of each row.

    Returns
    -------
    ndarray, shape (n, K)
        Weighted sums, in the type of ``values``.
    """
    # The indices are valid. mode="clip" skips numpy's check and the copy that it needs.
    corners = values.take(points, axis=0, mode="clip")
    return (weights.astype(values.dtype, copy=False)[:, None, :] @ corners)[:, 0, :]
