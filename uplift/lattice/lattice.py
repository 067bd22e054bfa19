"""The regular grid over RGB: axis nodes, node numbers, cells and neighbours. Nodes are
numbered blue fastest.
"""

import decimal
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import OptionError, unknown_name

CORNERS = np.array(list(product((0, 1), repeat=3)))
"""(8, 3) steps from the lowest corner of a cell to all its corners."""
AXES = ("srgb", "linear")
"""Spacings of `axis_nodes`: equal steps of the sRGB encoding, or of linear RGB."""
POWER_DIGITS = 40
"""Decimal digits of the powers in `axis_nodes`: more than twice those of a double."""
NEIGHBOURS = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)])
"""(26, 3) steps from a node to its neighbours."""


@dataclass(frozen=True, eq=False, repr=False)
class Lattice:
    """A regular grid of dim³ nodes over linear RGB, from the coordinates (dim,) along
    each axis, usually from 0 to 1.

    A cell is the box between eight neighbouring nodes; it has the number of its lowest
    corner, and consists of six tetrahedra. Positions are steps along the axes, in
    fractions between nodes. Sets of nodes and of cells are masks (dim³,).
    """

    nodes: Array

    def __post_init__(self) -> None:
        nodes = self.nodes
        valid = nodes.ndim == 1 and len(nodes) >= 2 and bool(np.isfinite(nodes).all())
        if not valid or not (np.diff(nodes) > 0).all():
            problem = (
                "the nodes of a lattice must be at least 2 increasing numbers, got "
                f"shape {nodes.shape}"
            )
            raise OptionError(problem, hint="use dim=2 or more")

    @property
    def dim(self) -> int:
        """Number of nodes along each axis."""
        return len(self.nodes)

    @property
    def size(self) -> int:
        """Number of nodes, dim³."""
        return self.dim**3

    @property
    def shape(self) -> tuple[int, int, int]:
        """(dim, dim, dim), the shape of an array over the nodes."""
        return (self.dim,) * 3

    def __repr__(self) -> str:
        return f"Lattice(dim {self.dim}, {self.nodes[0]:g} to {self.nodes[-1]:g})"

    @cached_property
    def points(self) -> Array:
        """(dim³, 3) target RGB of every node."""
        grid = np.meshgrid(self.nodes, self.nodes, self.nodes, indexing="ij")
        return np.stack(grid, axis=-1).reshape(-1, 3)

    def target(self, index: Indices) -> Array:
        """Target RGB (..., 3) of nodes (...)."""
        return self.nodes[self.position(index)]

    def index(self, position: Indices) -> Indices:
        """Numbers (...) of the nodes at positions (..., 3)."""
        # n = (r dim + g) dim + b
        return (position[..., 0] * self.dim + position[..., 1]) * self.dim + position[
            ..., 2
        ]

    def position(self, index: Indices) -> Indices:
        """Positions (..., 3) of nodes (...), 0 to dim − 1; the inverse of `index`."""
        return np.stack(np.unravel_index(index, self.shape), axis=-1)

    def to_steps(self, rgb: Array) -> Array:
        """Fractional positions (n, 3) of linear RGB (n, 3)."""
        return np.interp(rgb, self.nodes, np.arange(self.dim))

    def from_steps(self, steps: Array) -> Array:
        """Linear RGB (n, 3) at fractional positions (n, 3), of the edge for those
        outside; inverse of `to_steps`.
        """
        return np.interp(steps, np.arange(self.dim), self.nodes)

    def cell(self, rgb: Array) -> tuple[Indices, Array]:
        """Find the cells around linear RGB (n, 3): positions (n, 3), 0 to dim − 2, of
        their lowest corners, and fractions (n, 3) of the way across them. Colours
        outside the lattice belong to the nearest cell.
        """
        low = np.clip(
            np.searchsorted(self.nodes, rgb, side="right") - 1, 0, self.dim - 2
        )
        start = self.nodes[low]
        return low, (rgb - start) / (self.nodes[low + 1] - start)

    def corners(self, rgb: Array) -> tuple[Indices, Array]:
        """Corners (n, 4) of the tetrahedra around linear RGB (n, 3), with weights (n,
        4).
        """
        return self.tetrahedra(*self.cell(rgb))

    def tetrahedra(self, low: Indices, fraction: Array) -> tuple[Indices, Array]:
        """Corners (n, 4) of the tetrahedra of their cells in which colours lie, and the
        weights (n, 4), which sum to 1, of a result of `cell`.

        They lead from the lowest corner of the cell to the highest, along the axes in
        the order of decreasing fractions; equal ones are in the order red, green, blue.
        """
        strides = self.dim**2, self.dim, 1
        steps, weights = tetrahedron(fraction.T, strides, np.where)
        corners = self.index(low)[:, None] + np.stack(np.broadcast_arrays(*steps), 1)
        return corners, np.stack(weights, axis=1)

    def cell_corners(self, low: Indices) -> Indices:
        """All corners (n, 8) of the cells with lowest corners at positions (n, 3)."""
        return self.index(low)[:, None] + self.index(CORNERS)

    def needed(self, rgb: Array, margin: float) -> tuple[Mask, Mask]:
        """Cells of linear RGB (n, 3) and of colours within a margin, and the corners of
        their tetrahedra.
        """
        cells = np.zeros(self.size, dtype=bool)
        points = np.zeros(self.size, dtype=bool)
        first = self.cell(rgb - margin)[0]
        last = self.cell(rgb + margin)[0]
        for side in CORNERS:
            # Few colours are so near to a face that they have more than one cell.
            rows = np.flatnonzero(((first != last) | (side == 0)).all(axis=1))
            low = np.where(side == 1, last[rows], first[rows])
            cells[self.index(low)] = True
            start = self.nodes[low]
            size = self.nodes[low + 1] - start
            least, most = (
                np.clip((rgb[rows] + reach - start) / size, 0, 1)
                for reach in (-margin, margin)
            )
            room = corner_room(least, most)
            points[self.cell_corners(low)[room >= 0]] = True
        return cells, points

    def mask(self, points: Indices) -> Mask:
        """Set (dim³,) of nodes (k,)."""
        mask = np.zeros(self.size, dtype=bool)
        mask[points] = True
        return mask

    def corner_points(self, cells: Mask) -> Mask:
        """Nodes that are corners of cells."""
        dim = self.dim
        lowest = cells.reshape(self.shape)
        points = np.zeros(self.shape, dtype=bool)
        for r, g, b in CORNERS:
            points[r:, g:, b:] |= lowest[: dim - r, : dim - g, : dim - b]
        return points.ravel()

    def complete_cells(self, points: Mask) -> Mask:
        """Cells whose eight corners are all in a set of nodes."""
        dim = self.dim
        present = points.reshape(self.shape)
        cells = np.zeros(self.shape, dtype=bool)
        cells[:-1, :-1, :-1] = True
        for r, g, b in CORNERS:
            cells[: dim - r, : dim - g, : dim - b] &= present[r:, g:, b:]
        return cells.ravel()

    def cells_around(self, points: Mask) -> Mask:
        """Cells with a corner in a set of nodes."""
        every = self.complete_cells(np.ones(self.size, dtype=bool))
        return every & ~self.complete_cells(~points)

    def thinned(self, stride: int) -> tuple["Lattice", Indices]:
        """Return the coarser lattice of every ``stride``-th node and the last, and its
        nodes (m,) in this lattice.
        """
        kept = np.append(np.arange(0, self.dim - 1, stride), self.dim - 1)
        grid = np.meshgrid(kept, kept, kept, indexing="ij")
        positions = np.stack(grid, axis=-1).reshape(-1, 3)
        return Lattice(self.nodes[kept]), self.index(positions)

    def neighbours(self, index: Indices) -> tuple[Indices, Mask]:
        """Neighbours (n, 26) of nodes (n,), diagonal ones included, and which of them
        lie inside the lattice.
        """
        position = self.position(index)[:, None, :] + NEIGHBOURS
        inside: Mask = np.all((position >= 0) & (position < self.dim), axis=-1)
        return self.index(np.clip(position, 0, self.dim - 1)), inside


def tetrahedron(
    fractions: Any, strides: tuple[int, int, int], where: Callable[..., Any]
) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Steps (n) from the lowest corners of cells to the four of `Lattice.tetrahedra`,
    as strides of the axes, and their weights (n), for fractions (3, n) of NumPy or JAX.

    Conditions keep the derivatives of one tetrahedron where fractions are equal.
    """
    r, g, b = fractions
    red_first, red_second, green_second = r >= g, r >= b, g >= b

    def by_falling(red: Any, green: Any, blue: Any) -> tuple[Any, ...]:
        largest = where(red_second, red, blue), where(green_second, green, blue)
        smallest = where(green_second, blue, green), where(red_second, blue, red)
        middle = (
            where(green_second, green, smallest[1]),
            where(red_second, red, smallest[0]),
        )
        return tuple(where(red_first, *pair) for pair in (largest, middle, smallest))

    first, second, third = by_falling(r, g, b)
    one, other, _ = by_falling(*strides)
    steps = 0, one, one + other, sum(strides)
    return steps, (1 - first, first - second, second - third, third)


def corner_room(least: Array, most: Array) -> Array:
    """Smallest of the fractions (..., 3) of cells along the axes that lead to each
    corner (..., 8), at most, less the largest of the others, at least.

    That is the weight of a corner of `Lattice.tetrahedra`, if positive.
    """
    leads = CORNERS == 1
    ahead = np.where(leads, most[..., None, :], 1).min(axis=-1)
    behind = np.where(leads, 0, least[..., None, :]).max(axis=-1)
    room: Array = ahead - behind
    return room


def weighted_sum(values: Values, points: Indices, weights: Array) -> Values:
    """Sums (n, K) of rows (n, 4) of a table (m, K), float32 or float64, by weights (n,
    4).
    """
    # The indices are valid. mode="clip" skips numpy's check and the copy that it needs.
    corners = values.take(points, axis=0, mode="clip")
    return (weights.astype(values.dtype, copy=False)[:, None, :] @ corners)[:, 0, :]


def axis_nodes(spacing: str, dim: int) -> Array:
    """Return the positions (dim,) of the nodes of an axis in linear RGB, the same
    doubles on every CPU.

    So cubes of one dim and spacing have equal nodes wherever they were built. The
    powers of numpy differ in the last bit between instruction sets. Here they are
    computed in decimal arithmetic and rounded once, which is slow; IEEE 754 defines how
    every other operation rounds.

    >>> axis_nodes("srgb", 3).tolist()
    [0.0, 0.21404114048223255, 1.0]
    """
    if spacing not in AXES:
        raise unknown_name(spacing, AXES, "axis spacing")
    even = np.linspace(0.0, 1.0, dim)
    if spacing == "linear":
        return even
    # The transfer curve of IEC 61966-2-1: c / 12.92 near black, else ((c + 0.055) /
    # 1.055)^2.4
    context = decimal.Context(prec=POWER_DIGITS)
    exponent = decimal.Decimal.from_float(2.4)
    bases = ((even + 0.055) / 1.055).tolist()
    powers = [float(context.power(decimal.Decimal(base), exponent)) for base in bases]
    return np.where(even <= 0.04045, even / 12.92, powers)
