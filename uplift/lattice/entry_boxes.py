"""Atlas entries as extra nodes: asked at its colour, a cube answers with the entry's own spectrum.

Around every entry lies a box (`uplift.lattice.box_widths`), no two of which overlap. A colour x within
one is a mixture of the entry's colour e and of the point y where the ray from e through x leaves the box, x = (1 − t) e + t y. The
answer mixes the spectra of e and y alike: it has the very colour x, stays within [0, 1], meets the lattice at the
box's faces and the entry in its middle. numpy alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.lattice import Lattice

AROUND = np.array(list(product((-1, 0, 1), repeat=3)))
"""(27, 3) steps to the cells that a box may touch: it reaches a step at the most."""
NO_ENTRY = -1
MARGIN = 1e-6
"""Linear RGB by which rounding, to float32 too, may take a colour across the face of a cell."""


class BoxHits(NamedTuple):
    """Colours in boxes, k of those asked."""

    rows: Indices
    """(k,) which they are."""
    entry: Indices
    """(k,) the entry in whose box they lie."""
    share: Array
    """(k,) the lattice's share in the answer; the rest is the entry's."""
    away: Array
    """(k, 3) linear RGB to ask the lattice for."""


@dataclass(frozen=True, eq=False)
class EntryBoxes:
    """Entries at linear RGB (E, 3) whose boxes reach so many lattice steps (E,)."""

    lattice: Lattice
    rgb: Array
    reach: Array

    @cached_property
    def faces(self) -> tuple[Array, Array]:
        """Linear RGB of the lowest and of the highest corner (E, 3) of each box, cut off at the lattice's edge."""
        steps, reach = self.lattice.steps_along(self.rgb), self.reach[:, None]
        return self.lattice.at_steps(steps - reach), self.lattice.at_steps(steps + reach)

    @cached_property
    def cells(self) -> tuple[Indices, Indices]:
        """Numbers of the cells that boxes touch, ascending, and the entry of each such box."""
        low, high = (self.lattice.cell(face)[0] for face in self.faces)
        cells = self.lattice.cell(self.rgb)[0][:, None, :] + AROUND
        touched = ((cells >= low[:, None]) & (cells <= high[:, None])).all(axis=-1) & (self.reach > 0)[
            :, None
        ]
        entry, _ = np.nonzero(touched)
        number = self.lattice.index(cells[touched])
        order = np.argsort(number, kind="stable")
        return number[order], entry[order]

    @cached_property
    def touched(self) -> Mask:
        """(dim³,) whether a box touches a cell, by its number.

        Memory that is never written to is never taken, so this is cheap for the largest lattice.
        """
        touched = np.zeros(self.lattice.size, dtype=bool)
        touched[self.cells[0]] = True
        return touched

    def needs(self, cells: Mask) -> Mask:
        """Which lattice points (dim³,) answers take for colours in ``cells`` (dim³,), wherever these are in them.

        The corners of the cells and, where a box touches one, of all that the box touches: a colour in the box is
        answered from any point of its faces. Rounding may take that point across a face.
        """
        dim = self.lattice.dim
        asked = cells.reshape(dim, dim, dim)
        found = asked.copy()
        low, high = self.lattice.lowest(self.faces[0] - MARGIN), self.lattice.lowest(self.faces[1] + MARGIN)
        for entry in np.flatnonzero(self.reach > 0):
            box = tuple(slice(low[entry, axis], high[entry, axis] + 1) for axis in range(3))
            if asked[box].any():
                found[box] = True
        return self.lattice.corners_of(found.ravel())

    def __call__(self, rgb: Array) -> BoxHits:
        """Those of linear RGB (n, 3) that lie in a box."""
        return self.within(rgb, self.lattice.index(self.lattice.cell(rgb)[0]))

    def within(self, rgb: Array, cell: Indices) -> BoxHits:
        """The same, for who knows the numbers (n,) of their cells."""
        rows, entry = self._boxes(rgb, cell)
        middle = self.rgb[entry]
        ray = rgb[rows] - middle
        low, high = (face[entry] for face in self.faces)
        room = np.where(ray > 0, high - middle, middle - low)
        share = np.divide(np.abs(ray), room, out=np.zeros_like(ray), where=ray != 0).max(axis=1)
        away, moved = rgb[rows], share > 0
        away[moved] = np.clip(middle[moved] + ray[moved] / share[moved, None], 0, 1)
        return BoxHits(rows, entry, share, away)

    def _boxes(self, rgb: Array, cell: Indices) -> tuple[Indices, Indices]:
        """Which (k,) of linear RGB (n, 3) lie in a box, and the entries (k,) of those."""
        near = np.flatnonzero(self.touched[cell])
        found = np.full(len(near), NO_ENTRY)
        cells, entries = self.cells
        first, last = (np.searchsorted(cells, cell[near], side=side) for side in ("left", "right"))
        low, high = self.faces
        for turn in range(int((last - first).max(initial=0))):
            rows = np.flatnonzero(first + turn < last)
            candidate, asked = entries[first[rows] + turn], rgb[near[rows]]
            inside = ((asked >= low[candidate]) & (asked <= high[candidate])).all(axis=1)
            found[rows[inside]] = candidate[inside]
        held = found != NO_ENTRY
        return near[held], found[held]
