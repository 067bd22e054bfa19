"""Seeding: atlas entries take lattice points around their colours (Tódová 2020, section 3.1.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.lattice import CORNERS, Lattice


class Collision(NamedTuple):
    """Two entries with the same nearest lattice point."""

    kept: int
    """Row of the entry that owns the point, being closer."""
    lost: int
    """Row of the other entry."""


@dataclass(frozen=True, eq=False, repr=False)
class Seeds:
    """Lattice points that start from atlas entries.

    Parameters
    ----------
    rgb : ndarray, shape (E, 3)
        Linear RGB of the entries.
    points : ndarray of int, shape (S,)
        Point numbers.
    entry : ndarray of int, shape (S,)
        Row of the entry that each point starts from.
    primary : ndarray of bool, shape (S,)
        True for the point nearest to its entry.
    collisions : tuple of Collision
        Entries without a primary point.
    """

    rgb: Array
    points: Indices
    entry: Indices
    primary: Mask
    collisions: tuple[Collision, ...]


def seed(lattice: Lattice, rgb: Array) -> Seeds:
    """Assign lattice points to atlas entries, independently of the order of the entries.

    Every entry gets its nearest point, unless a closer entry owns it. Then, in rounds, every entry gets the
    nearest free corner of its cell: the "better approach" of the thesis.

    Parameters
    ----------
    lattice : Lattice
        The lattice.
    rgb : ndarray, shape (E, 3)
        Linear RGB of the entries, in [0, 1].

    Returns
    -------
    Seeds
        The assignment.
    """
    cells, _ = lattice.corners(rgb)
    distance = np.linalg.norm(lattice.points[cells] - rgb[:, None, :], axis=-1)
    by_distance = np.argsort(distance, axis=1, kind="stable")
    queue = np.take_along_axis(cells, by_distance, axis=1)
    nearest = np.take_along_axis(distance, by_distance, axis=1)[:, 0]
    order = np.lexsort([*rgb.T, nearest])
    owner, collisions = _assign_primaries(queue, order)
    primaries = len(owner)
    for _ in CORNERS:
        for entry in order:
            free = next((int(point) for point in queue[entry] if point not in owner), None)
            if free is not None:
                owner[free] = int(entry)
    return Seeds(
        rgb=rgb,
        points=np.array(list(owner), dtype=np.int64),
        entry=np.array(list(owner.values()), dtype=np.int64),
        primary=np.arange(len(owner)) < primaries,
        collisions=collisions,
    )


def _assign_primaries(queue: Indices, order: Indices) -> tuple[dict[int, int], tuple[Collision, ...]]:
    """Entries by their nearest points, and the entries that lost theirs."""
    owner: dict[int, int] = {}
    collisions = []
    for entry in order:
        kept = owner.setdefault(int(queue[entry, 0]), int(entry))
        if kept != entry:
            collisions.append(Collision(kept, int(entry)))
    return owner, tuple(collisions)
