"""Atlas entries as extra nodes: asked at its colour, a cube answers with the entry's own spectrum.

Around every entry lies a box (`uplift.fit.reach`), no two of which overlap. A colour x within one is a mixture of
the entry's colour e and of the point y where the ray from e through x leaves the box, x = (1 − t) e + t y. The
answer mixes the spectra of e and y alike: it has the very colour x, stays within [0, 1], meets the lattice at the
box's faces and the entry in its middle. numpy alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from uplift.lattice import Indices, Lattice
from uplift.sensor import Array

AROUND = np.array(list(product((-1, 0, 1), repeat=3)))
"""(27, 3) steps to the cells that a box may touch: it reaches a step at the most."""
NO_ENTRY = -1


@dataclass(frozen=True, eq=False)
class Pins:
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

    def __call__(self, rgb: Array) -> tuple[Array, Indices, Array]:
        """The lattice's part in the answers to linear RGB (n, 3).

        Colours y (n, 3) to ask the lattice for, the entry (n,) that each mixes with, −1 for none, and the
        lattice's share t (n,).
        """
        entry = self._entry(rgb)
        asked, share = rgb.copy(), np.ones(len(rgb))
        rows = np.flatnonzero(entry != NO_ENTRY)
        middle = self.rgb[entry[rows]]
        ray = rgb[rows] - middle
        low, high = (face[entry[rows]] for face in self.faces)
        room = np.where(ray > 0, high - middle, middle - low)
        share[rows] = np.divide(np.abs(ray), room, out=np.zeros_like(ray), where=ray != 0).max(axis=1)
        away = share[rows] > 0
        asked[rows[away]] = np.clip(middle[away] + ray[away] / share[rows[away], None], 0, 1)
        return asked, entry, share

    def _entry(self, rgb: Array) -> Indices:
        """The entry (n,) whose box holds linear RGB (n, 3), −1 for none."""
        found = np.full(len(rgb), NO_ENTRY)
        cells, entries = self.cells
        if not len(cells):
            return found
        number = self.lattice.index(self.lattice.cell(rgb)[0])
        first, last = (np.searchsorted(cells, number, side=side) for side in ("left", "right"))
        low, high = self.faces
        for turn in range(int((last - first).max(initial=0))):
            rows = np.flatnonzero(first + turn < last)
            candidate = entries[first[rows] + turn]
            inside = ((rgb[rows] >= low[candidate]) & (rgb[rows] <= high[candidate])).all(axis=1)
            found[rows[inside]] = candidate[inside]
        return found
