"""The nodes around colours, and mixtures of what lies on them (docs/mathematics.md, 8). numpy alone.

Around a colour are the eight corners of its cell and, near an atlas entry, the entry (`uplift.lattice.entry_boxes`).
Whatever nodes carry, be it coefficients, spectra or errors, is mixed alike, or taken from the nearest node.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import ColourError
from uplift.cube import CubeData
from uplift.lattice import weighted_sum
from uplift.lattice.entry_boxes import BoxHits


@dataclass(frozen=True, eq=False)
class Nodes:
    """The nodes around n colours.

    Parameters
    ----------
    points, weights : (n, 8) lattice points and their weights, summing to 1.
    rows : (k,) colours that an entry has a part in.
    entry : (k,) that entry.
    share : (k,) the lattice's share; the rest is the entry's.
    """

    points: Indices
    weights: Array
    rows: Indices
    entry: Indices
    share: Array

    def weighted_sum(self, lattice: Values, atlas: Values) -> Values:
        """(n, K) of what lattice points (dim³, K) and entries (E, K) carry, in the type that they have."""
        found = weighted_sum(lattice, self.points, self.weights)
        share = self.share.astype(found.dtype)[:, None]
        found[self.rows] = share * found[self.rows] + (1 - share) * atlas[self.entry]
        return found

    def nearest(self, lattice: Values, atlas: Values) -> Values:
        """(n, K) of what the node of most weight carries, of lattice points (dim³, K) and entries (E, K)."""
        best = self.weights.argmax(axis=1)[:, None]
        points, weights = (
            np.take_along_axis(part, best, axis=1)[:, 0] for part in (self.points, self.weights)
        )
        found = lattice[points].astype(np.result_type(lattice, atlas), copy=False)
        own = self.share * (1 + weights[self.rows]) <= 1
        found[self.rows[own]] = atlas[self.entry[own]]
        return found


def around(data: CubeData, rgb: Array) -> Nodes:
    """The nodes around linear RGB (n, 3) in [0, 1]. Raises `ColourError` for what a sparse cube has no nodes for."""
    low, fraction, pinned = _asked(data, rgb)
    if data.complete_cells is not None:
        require(data.complete_cells[data.lattice.index(low)], rgb)
    points, weights = data.lattice.cell_corners(low, fraction)
    return Nodes(points, weights, pinned.rows, pinned.entry, pinned.lattice_weight)


def holds(data: CubeData, rgb: Array) -> Mask:
    """Whether (n,) there are nodes for linear RGB (n, 3) in [0, 1]."""
    if data.complete_cells is None:
        return np.ones(len(rgb), dtype=bool)
    return data.complete_cells[cells(data, rgb)]


def cells(data: CubeData, rgb: Array) -> Indices:
    """Numbers (n,) of the cells that the lattice is asked in for linear RGB (n, 3) in [0, 1]."""
    return data.lattice.index(_asked(data, rgb)[0])


def require(held: Mask, rgb: Array) -> None:
    """Raises `ColourError`, quoting the first of linear RGB (n, 3) that is not ``held`` (n,)."""
    if not held.all():
        values = ", ".join(f"{value:.6g}" for value in rgb[int(held.argmin())])
        raise ColourError(
            f"the cube was built for the colours of a scene, and linear RGB ({values}) is none of them",
            hint="build it with the image in --scene, or use --fill (in Python: cube.fill_missing())",
        )


def _asked(data: CubeData, rgb: Array) -> tuple[Indices, Array, BoxHits]:
    """Lowest corner (n, 3) and fraction (n, 3) of the cells that the lattice is asked in, and what lies in boxes."""
    lattice = data.lattice
    low, fraction = lattice.cell(rgb)
    pinned = data.entry_boxes.find_in_cells(rgb, lattice.index(low))
    low[pinned.rows], fraction[pinned.rows] = lattice.cell(pinned.exit_rgb)
    return low, fraction, pinned
