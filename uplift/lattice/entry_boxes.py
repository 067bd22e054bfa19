"""Boxes around atlas entries: a query at the colour of an entry returns the spectrum of the entry.

No two boxes overlap; `uplift.fit.seeds.half_widths` makes them as wide as that allows. A colour x inside a box
is x = (1 − t) e + t y, with the entry's colour e and the point y where the ray from e through x leaves the box. The
answer mixes the spectra at e and y by the same weights. It has exactly the colour x and stays within [0, 1]. It equals
the lattice on the faces of the box, and the entry at its centre. Needs numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any, NamedTuple, Protocol

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import ProgressCallback
from uplift.lattice.lattice import Lattice
from uplift.lattice.point_table import NO_ENTRY

CELL_BLOCK = np.array(list(product((-1, 0, 1), repeat=3)))
"""(27, 3) steps to the cells that a box can touch: its half width is at most one step."""
MARGIN = 1e-6
"""Linear RGB by which rounding, to float32 too, can move a colour across the face of a cell."""


class BoxHits(NamedTuple):
    """The k of n colours that lie in boxes."""

    rows: Indices
    """(k,) row numbers of the colours."""
    entry: Indices
    """(k,) row of the entry whose box contains the colour."""
    lattice_weight: Array
    """(k,) weight of the lattice in the answer, 0 to 1; the entry has the rest."""
    exit_rgb: Array
    """(k, 3) linear RGB of the point at which the lattice is evaluated."""


@dataclass(frozen=True, eq=False, repr=False)
class EntryBoxes:
    """Boxes in a lattice around entries of linear RGB (E, 3), of half widths (E,) in steps: 0 to 1, 0 for none."""

    lattice: Lattice
    rgb: Array
    half_width: Array

    def __repr__(self) -> str:
        return f"EntryBoxes({np.count_nonzero(self.half_width)} boxes in {self.lattice})"

    @cached_property
    def faces(self) -> tuple[Array, Array]:
        """Linear RGB (E, 3) of the lowest and of the highest corner of each box, clipped to the lattice."""
        steps, half = self.lattice.to_steps(self.rgb), self.half_width[:, None]
        return self.lattice.from_steps(steps - half), self.lattice.from_steps(steps + half)

    @cached_property
    def cells(self) -> tuple[Indices, Indices]:
        """Numbers of the cells that boxes touch, ascending, and the entry of each of these boxes."""
        low, high = (self.lattice.lowest_corner(face)[:, None] for face in self.faces)
        cells = self.lattice.lowest_corner(self.rgb)[:, None] + CELL_BLOCK
        touched = ((cells >= low) & (cells <= high)).all(axis=-1) & (self.half_width > 0)[:, None]
        entry, _ = np.nonzero(touched)
        number = self.lattice.index(cells[touched])
        order = np.argsort(number, kind="stable")
        return number[order], entry[order]

    @cached_property
    def touched_cells(self) -> Mask:
        """(dim³,) True for cells that a box touches. Untouched pages of the array take no memory."""
        touched = np.zeros(self.lattice.size, dtype=bool)
        touched[self.cells[0]] = True
        return touched

    def required_points(self, cells: Mask) -> Mask:
        """Nodes needed to answer any colour in a set of cells, both as masks (dim³,).

        They are the corners of the cells and, where a box touches one, the corners of all cells that the box
        touches: a colour in the box is answered from a point on its faces, within `MARGIN`.
        """
        requested = cells.reshape(self.lattice.shape)
        required = requested.copy()
        low = self.lattice.lowest_corner(self.faces[0] - MARGIN)
        high = self.lattice.lowest_corner(self.faces[1] + MARGIN)
        for entry in np.flatnonzero(self.half_width > 0):
            box = tuple(slice(low[entry, axis], high[entry, axis] + 1) for axis in range(3))
            if requested[box].any():
                required[box] = True
        return self.lattice.corner_points(required.ravel())

    def find(self, rgb: Array) -> BoxHits:
        """Find which of the linear RGB (n, 3) lie in boxes."""
        return self.find_in_cells(rgb, self.lattice.index(self.lattice.lowest_corner(rgb)))

    def find_in_cells(self, rgb: Array, cell: Indices) -> BoxHits:
        """Do the same as `find` for colours whose cells (n,) are known."""
        rows, entry = self._boxes(rgb, cell)
        centre = self.rgb[entry]
        ray = rgb[rows] - centre
        low, high = (face[entry] for face in self.faces)
        # x = (1 − t) e + t y: t is the largest fraction, over the axes, of the way from e to the face that x moves to.
        room = np.where(ray > 0, high - centre, centre - low)
        weight = np.divide(np.abs(ray), room, out=np.zeros_like(ray), where=ray != 0).max(axis=1)
        exit_rgb, moved = rgb[rows], weight > 0
        exit_rgb[moved] = np.clip(centre[moved] + ray[moved] / weight[moved, None], 0, 1)
        return BoxHits(rows, entry, weight, exit_rgb)

    def _boxes(self, rgb: Array, cell: Indices) -> tuple[Indices, Indices]:
        """Rows (k,) of the colours (n, 3) that lie in a box, and the entries (k,) of the boxes."""
        near = np.flatnonzero(self.touched_cells[cell])
        found = np.full(len(near), NO_ENTRY)
        cells, entries = self.cells
        first, last = (np.searchsorted(cells, cell[near], side=side) for side in ("left", "right"))
        low, high = self.faces
        for turn in range(int((last - first).max(initial=0))):
            rows = np.flatnonzero(first + turn < last)
            candidate, colour = entries[first[rows] + turn], rgb[near[rows]]
            inside = ((colour >= low[candidate]) & (colour <= high[candidate])).all(axis=1)
            found[rows[inside]] = candidate[inside]
        hit = found != NO_ENTRY
        return near[hit], found[hit]


class SceneLike(Protocol):
    """Colours that restrict a build to the nodes that they require."""

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Return the mask (dim³,) of the required nodes, and report events of stage ``"images"``."""
        ...

    def describe(self) -> list[dict[str, Any]]:
        """Describe the sources of the colours for the provenance of the cube, in JSON values."""
        ...
