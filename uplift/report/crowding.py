"""Entries that share a voxel: they share its eight corners too, and none of them gets all it needs."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.lattice import Lattice
from uplift.report.fidelity import Entries
from uplift.sensor import Array


@dataclass(frozen=True, eq=False)
class Crowd:
    """A voxel, by its lowest corner's position and its bounds (2, 3) in linear RGB, and the entries within."""

    cell: tuple[int, int, int]
    bounds: Array
    entries: Entries


def crowds(lattice: Lattice, entries: Entries) -> tuple[Crowd, ...]:
    """The voxels of two entries or more, in the order of the worst entry of each."""
    rows: dict[tuple[int, int, int], list[int]] = {}
    for row, (red, green, blue) in enumerate(entries.cells.tolist()):
        rows.setdefault((red, green, blue), []).append(row)
    return tuple(
        Crowd(cell, lattice.nodes[entries.cells[shared[0]] + [[0], [1]]], entries.take(shared))
        for cell, shared in rows.items()
        if len(shared) > 1
    )
