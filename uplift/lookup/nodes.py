"""The nodes around colours, and weighted sums of their values (docs/mathematics.md, 8). Needs numpy only.

The nodes of a colour are the eight corners of its cell and, in an entry box, the atlas entry. Coefficients, spectra
and errors are all interpolated by the same weights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import ColourError
from uplift.cube import CubeData
from uplift.lattice import BoxHits, weighted_sum


@dataclass(frozen=True, eq=False, repr=False)
class Nodes:
    """The nodes around n colours, k of them in entry boxes.

    Parameters
    ----------
    points : ndarray of int, shape (n, 8)
        Lattice points.
    weights : ndarray, shape (n, 8)
        Their weights, summing to 1.
    rows : ndarray of int, shape (k,)
        Colours in entry boxes.
    entry : ndarray of int, shape (k,)
        Their entries.
    lattice_weight : ndarray, shape (k,)
        Weight of the lattice; the entry has the rest.
    exit_rgb : ndarray, shape (k, 3)
        Linear RGB at which the lattice is evaluated.
    """

    points: Indices
    weights: Array
    rows: Indices
    entry: Indices
    lattice_weight: Array
    exit_rgb: Array

    def weighted_sum(self, lattice: Values, atlas: Values) -> Values:
        """Weighted sums (n, K) of the values of lattice points (dim³, K) and entries (E, K), in their type."""
        total = weighted_sum(lattice, self.points, self.weights)
        return self.mix(total, atlas[self.entry])

    def mix(self, lattice: Values, entry: Values) -> Values:
        """Mix values (n, K) of the lattice, in place, with those (k, K) of the entries whose boxes contain colours."""
        weight = self.lattice_weight.astype(lattice.dtype)[:, None]
        lattice[self.rows] = weight * lattice[self.rows] + (1 - weight) * entry
        return lattice

    def nearest(self) -> tuple[Indices, Indices, Indices]:
        """Return the nodes of largest weight: lattice points (n,), and rows and entries (m,) where it is an entry."""
        best = self.weights.argmax(axis=1)[:, None]
        points = np.take_along_axis(self.points, best, axis=1)[:, 0]
        weights = np.take_along_axis(self.weights, best, axis=1)[:, 0]
        is_entry = self.lattice_weight * (1 + weights[self.rows]) <= 1
        return points, self.rows[is_entry], self.entry[is_entry]

    def lattice_rgb(self, rgb: Array) -> Array:
        """Return the colours (n, 3) at which the lattice is evaluated for linear RGB (n, 3)."""
        if not self.rows.size:
            return rgb
        evaluated = rgb.copy()
        evaluated[self.rows] = self.exit_rgb
        return evaluated


def around(data: CubeData, rgb: Array) -> Nodes:
    """Return the nodes around linear RGB (n, 3) in [0, 1]; `ColourError` if a sparse cube lacks one of them."""
    low, fraction, hits = _locate(data, rgb)
    if data.complete_cells is not None:
        require(data.complete_cells[data.lattice.index(low)], rgb)
    points, weights = data.lattice.cell_corners(low, fraction)
    return Nodes(points, weights, *hits)


def covers(data: CubeData, rgb: Array) -> Mask:
    """Return the colours (n, 3), linear RGB in [0, 1], whose nodes are all present."""
    if data.complete_cells is None:
        return np.ones(len(rgb), dtype=bool)
    return data.complete_cells[cells(data, rgb)]


def cells(data: CubeData, rgb: Array) -> Indices:
    """Return the numbers (n,) of the cells in which the lattice is evaluated for linear RGB (n, 3) in [0, 1]."""
    return data.lattice.index(_locate(data, rgb)[0])


def require(covered: Mask, rgb: Array) -> None:
    """Raise `ColourError` for the first colour (n, 3) that is not covered (n,)."""
    if not covered.all():
        values = ", ".join(f"{value:.6g}" for value in rgb[int(covered.argmin())])
        raise ColourError(
            f"the cube answers the colours of its scene only, got linear RGB ({values})",
            code="colour-not-in-scene",
            hint="build the cube with this colour in its scene, or fill it with Cube.fill_missing",
        )


def _locate(data: CubeData, rgb: Array) -> tuple[Indices, Array, BoxHits]:
    """Lowest corners (n, 3) and fractions (n, 3) of the cells where the lattice is evaluated, and hits of boxes."""
    lattice = data.lattice
    low, fraction = lattice.cell(rgb)
    hits = data.entry_boxes.find_in_cells(rgb, lattice.index(low))
    low[hits.rows], fraction[hits.rows] = lattice.cell(hits.exit_rgb)
    return low, fraction, hits
