"""Entries that stand close to others: the nearer, the smaller the box in which answers lead over to their spectra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData
from uplift.report.fidelity import EntryErrors

CLOSE = 1 + 1e-9
"""Lattice steps within which another entry crowds; two in a voxel are never farther apart."""


@dataclass(frozen=True, eq=False)
class Crowding:
    """The crowded of a cube's own entries, those first that the lattice by itself makes the worst of.

    Parameters
    ----------
    entries : k of them.
    nearest, apart : (k) name of the nearest other entry, and (k,) lattice steps to it along the axis that has most.
    lost : entries that no colour is answered with, and for each the entry of the same colour that is.
    """

    entries: EntryErrors
    nearest: tuple[str, ...]
    apart: Array
    lost: tuple[tuple[str, str], ...]


def crowding(data: CubeData, entries: EntryErrors) -> Crowding:
    """Who stands within a lattice step of whom; ``entries`` are some or all of the cube's own."""
    assert entries.worst_lattice is not None
    names = data.atlas.names
    nearest, apart = _nearest(data.lattice.steps_along(data.atlas.rgb))
    place = {name: row for row, name in enumerate(names)}
    rows = np.array([place[name] for name in entries.names])
    order = np.argsort(-entries.worst_lattice, kind="stable")
    kept = order[apart[rows[order]] <= CLOSE]
    return Crowding(
        entries.take(kept),
        tuple(names[other] for other in nearest[rows[kept]]),
        apart[rows[kept]],
        _lost(data),
    )


def _nearest(steps: Array) -> tuple[Indices, Array]:
    """The nearest other row (n,) of steps (n, 3), and how far (n,) it is; infinitely where there is no other."""
    from scipy.spatial import KDTree

    if len(steps) < 2:
        return np.zeros(len(steps), dtype=np.int64), np.full(len(steps), np.inf)
    apart, found = KDTree(steps).query(steps, k=2, p=np.inf)
    # A row finds itself first, or after another of the same colour.
    return np.where(found[:, 0] == np.arange(len(steps)), found[:, 1], found[:, 0]), apart[:, 1]


def _lost(data: CubeData) -> tuple[tuple[str, str], ...]:
    names, rows = data.atlas.names, np.flatnonzero(data.atlas.half_width == 0)
    pinned = data.entry_boxes(data.atlas.rgb[rows])
    return tuple(
        (names[rows[row]], names[other]) for row, other in zip(pinned.rows, pinned.entry, strict=True)
    )
