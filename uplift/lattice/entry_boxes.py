"""Boxes around atlas entries: a query at the colour of an entry returns the spectrum of
the entry.

No two boxes overlap; `uplift.fit.seeds.half_widths` makes them as wide as that allows.
A colour x inside a box is x = (1 − t) e + t y, with the entry's colour e and the point
y where the ray from e through x leaves the box. The answer mixes the spectra at e and y
by the same weights. It has exactly the colour x and stays within [0, 1]. It equals the
lattice on the faces of the box, and the entry at its centre. Needs numpy only.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.text import pluralise
from uplift.lattice.lattice import Lattice, weighted_sum
from uplift.lattice.point_table import NO_ENTRY

CORE = 0.1
"""Part of the half width of a box outside [0, 1] up to which the entry alone answers.
"""
CELL_BLOCK = np.array(list(product((-1, 0, 1), repeat=3)))
"""(27, 3) steps to the cells that a box can touch: its half width is at most one step.
"""
MARGIN = 1e-6
"""Linear RGB by which rounding, to float32 too, can move a colour."""


class BoxHits(NamedTuple):
    """The k of n colours that lie in boxes."""

    rows: Indices
    """(k,) row numbers of the colours."""
    entry: Indices
    """(k,) row of the entry whose box contains the colour."""
    lattice_weight: Array
    """(k,) weight in the answer, 0 to 1, of the lattice or, outside [0, 1], of what
    answers without the entry.
    """
    exit_rgb: Array
    """(k, 3) linear RGB of the point at which that is evaluated."""

    def mix(self, values: Values, entry: Values) -> Values:
        """Mix values (n, K), in place, with those (k, K) of the entries: t · values +
        (1 − t) · entry.
        """
        if self.rows.size:
            weight = self.lattice_weight.astype(values.dtype)[:, None]
            values[self.rows] = weight * values[self.rows] + (1 - weight) * entry
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Nodes:
    """The nodes around n colours: four corners of a tetrahedron each and, for k of
    them, the entry of a box.
    """

    points: Indices
    """(n, 4) numbers of the corners in the lattice."""
    weights: Array
    """(n, 4) their weights w, summing to 1."""
    hits: BoxHits
    """The colours in entry boxes. There the lattice has weight t and is evaluated where
    the ray leaves the box.
    """

    def weighted_sum(self, lattice: Values, atlas: Values) -> Values:
        """Σ w · values of the lattice (dim³, K), mixed with those of the entries (E,
        K): (n, K), in their type.
        """
        values = weighted_sum(lattice, self.points, self.weights)
        return self.hits.mix(values, atlas[self.hits.entry])

    def nearest(self) -> tuple[Indices, Indices, Indices]:
        """Return the corners of largest weight (n,), and the rows and entries (m,)
        where an entry weighs more.
        """
        best = self.weights.argmax(axis=1)[:, None]
        points = np.take_along_axis(self.points, best, axis=1)[:, 0]
        weights = np.take_along_axis(self.weights, best, axis=1)[:, 0]
        hits = self.hits
        # 1 − t ≥ t · w
        is_entry = hits.lattice_weight * (1 + weights[hits.rows]) <= 1
        return points, hits.rows[is_entry], hits.entry[is_entry]

    def lattice_rgb(self, rgb: Array) -> Array:
        """Return the colours (n, 3) at which the lattice is evaluated for linear RGB
        (n, 3).
        """
        evaluated = rgb.copy()
        evaluated[self.hits.rows] = self.hits.exit_rgb
        return evaluated


NO_ROWS = np.zeros(0, dtype=np.int64)
NO_HITS = BoxHits(NO_ROWS, NO_ROWS, np.zeros(0), np.zeros((0, 3)))


@dataclass(frozen=True, eq=False, repr=False)
class EntryBoxes:
    """Boxes in a lattice around entries of linear RGB (E, 3), of half widths (E,) in
    steps: 0 to 1, 0 for none.
    """

    lattice: Lattice
    rgb: Array
    half_width: Array

    def __repr__(self) -> str:
        boxes = pluralise(int(np.count_nonzero(self.half_width)), "box")
        return f"EntryBoxes({boxes} in {self.lattice})"

    @cached_property
    def faces(self) -> tuple[Array, Array]:
        """Linear RGB (E, 3) of the lowest and of the highest corner of each box,
        clipped to the lattice.

        Where an entry is within `MARGIN` of the edge, the face lies beyond: between the
        two, rounding would decide.
        """
        rgb = self.rgb
        steps = self.lattice.to_steps(self.rgb)
        half = self.half_width[:, None]
        low = self.lattice.from_steps(steps - half)
        high = self.lattice.from_steps(steps + half)
        at_start = rgb < self.lattice.nodes[0] + MARGIN
        at_end = rgb > self.lattice.nodes[-1] - MARGIN
        first = np.where(at_start, 2 * rgb - high, low)
        return first, np.where(at_end, 2 * rgb - low, high)

    @cached_property
    def cells(self) -> tuple[Indices, Indices]:
        """Numbers of the cells that boxes touch, ascending, and the entry of each of
        these boxes.
        """
        low, high = (self.lattice.cell(face)[0][:, None] for face in self.faces)
        cells = self.lattice.cell(self.rgb)[0][:, None] + CELL_BLOCK
        touched = ((cells >= low) & (cells <= high)).all(axis=-1)
        touched &= (self.half_width > 0)[:, None]
        entry, _ = np.nonzero(touched)
        number = self.lattice.index(cells[touched])
        order = np.argsort(number, kind="stable")
        return number[order], entry[order]

    @cached_property
    def touched_cells(self) -> Mask:
        """(dim³,) True for cells that a box touches. Untouched pages of the array take
        no memory.
        """
        touched = np.zeros(self.lattice.size, dtype=bool)
        touched[self.cells[0]] = True
        return touched

    def required_points(self, colours: Iterable[Array]) -> Mask:
        """Nodes (dim³,) needed to answer arrays of linear RGB (n, 3), within `MARGIN`.

        They are the corners of their tetrahedra and, where a box touches the cell of
        one, of all cells that the box touches: a colour in the box is answered from a
        point on its faces.
        """
        lattice = self.lattice
        requested = np.zeros(lattice.size, dtype=bool)
        points = np.zeros(lattice.size, dtype=bool)
        for rgb in colours:
            cells, corners = lattice.needed(rgb, MARGIN)
            requested |= cells
            points |= corners
        requested = requested.reshape(lattice.shape)
        around = np.zeros(lattice.shape, dtype=bool)
        low, _ = lattice.cell(self.faces[0] - MARGIN)
        high, _ = lattice.cell(self.faces[1] + MARGIN)
        for entry in np.flatnonzero(self.half_width > 0):
            box = tuple(
                slice(low[entry, axis], high[entry, axis] + 1) for axis in range(3)
            )
            if requested[box].any():
                around[box] = True
        return points | lattice.corner_points(around.ravel())

    def locate(self, rgb: Array) -> tuple[Indices, Array, BoxHits]:
        """Find the cells (`Lattice.cell`) in which the lattice is evaluated for linear
        RGB (n, 3), and their boxes.

        In a box the lattice is evaluated on the face, in the cell in which the ray
        leaves the box.
        """
        # x = (1 − t) e + t y in the box of entry e: the lattice answers y, with weight
        # t (8).
        low, fraction = self.lattice.cell(rgb)
        hits = self.find(rgb, self.lattice.index(low))
        low[hits.rows], fraction[hits.rows] = self.lattice.cell(hits.exit_rgb)
        return low, fraction, hits

    def nodes(self, rgb: Array) -> Nodes:
        """Find the nodes around linear RGB (n, 3), whether present or not."""
        low, fraction, hits = self.locate(rgb)
        return Nodes(*self.lattice.tetrahedra(low, fraction), hits)

    def cell(self, rgb: Array) -> Indices:
        """Return the numbers (n,) of the cells in which the lattice is evaluated for
        linear RGB (n, 3).
        """
        return self.lattice.index(self.locate(rgb)[0])

    def find(self, rgb: Array, cell: Indices | None = None) -> BoxHits:
        """Find which of the linear RGB (n, 3) lie in boxes. Their ``cell`` (n,) is
        computed if it is not known.
        """
        if not len(self.rgb):
            return NO_HITS
        numbers, entries = self.cells
        cell = self.lattice.index(self.lattice.cell(rgb)[0]) if cell is None else cell
        # Boxes that touch the cell of a colour are tested in turn.
        rows = np.flatnonzero(self.touched_cells[cell])
        entry = np.full(len(rows), NO_ENTRY)
        first, last = (
            np.searchsorted(numbers, cell[rows], side=side)
            for side in ("left", "right")
        )
        for turn in range(int((last - first).max(initial=0))):
            near = np.flatnonzero(first + turn < last)
            candidate = entries[first[near] + turn]
            colour = rgb[rows[near]]
            low, high = (face[candidate] for face in self.faces)
            inside = ((colour >= low) & (colour <= high)).all(axis=1)
            entry[near[inside]] = candidate[inside]
        rows = rows[entry != NO_ENTRY]
        entry = entry[entry != NO_ENTRY]
        centre = self.rgb[entry]
        ray = rgb[rows] - centre
        low, high = (face[entry] for face in self.faces)
        # x = (1 − t) e + t y: t is the largest fraction, over the axes, of the way from
        # e to the face that x moves to.
        room = np.where(ray > 0, high - centre, centre - low)
        along = np.zeros_like(ray)
        np.divide(np.abs(ray), room, out=along, where=ray != 0)
        weight = along.max(axis=1)
        exit_rgb = rgb[rows]
        moved = weight > 0
        reached = centre[moved] + ray[moved] / weight[moved, None]
        exit_rgb[moved] = np.clip(reached, 0, 1)
        return BoxHits(rows, entry, weight, exit_rgb)


@dataclass(frozen=True, eq=False, repr=False)
class OutsideBoxes:
    """Boxes around entries of linear RGB (O, 3) outside [0, 1], of half widths (O,) in
    linear RGB, 0 for none.

    They overlap neither each other nor [0, 1], so that answers are continuous there.
    """

    rgb: Array
    half_width: Array

    def __repr__(self) -> str:
        boxes = pluralise(int(np.count_nonzero(self.half_width)), "box")
        return f"OutsideBoxes({boxes})"

    def find(self, rgb: Values) -> BoxHits:
        """Find which of the linear RGB (n, 3) lie in boxes."""
        if not len(self.rgb):
            return NO_HITS
        rows = np.flatnonzero(((rgb < 0) | (rgb > 1)).any(axis=1))
        entry = np.full(len(rows), NO_ENTRY)
        distance = np.ones(len(rows))
        for box in np.flatnonzero(self.half_width > 0):
            from_centre = np.abs(rgb[rows] - self.rgb[box]).max(axis=1)
            inside = from_centre < self.half_width[box]
            entry[inside] = box
            distance[inside] = from_centre[inside] / self.half_width[box]
        hit = entry != NO_ENTRY
        # The weight is 0 in the core of the box, and rises linearly to 1 on its faces.
        weight = np.maximum(distance[hit] - CORE, 0) / (1 - CORE)
        return BoxHits(rows[hit], entry[hit], weight, rgb[rows[hit]])
