"""Seeding: every atlas entry takes the eight corners of its voxel, nearest first (Tódová 2020, 3.1.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.lattice import Lattice


class Collision(NamedTuple):
    """Two entries with the same primary lattice point; ``kept`` has it, being nearer."""

    kept: int
    lost: int


@dataclass(frozen=True, eq=False)
class Seeds:
    """Lattice points (S,), the entry each is based on (S,), and whether it is that entry's primary point (S,)."""

    points: Indices
    entry: Indices
    primary: Mask
    collisions: tuple[Collision, ...]


def seed(lattice: Lattice, rgb: Array) -> Seeds:
    """Share the lattice out among entries of linear RGB (E, 3), all within [0, 1].

    Primary points first, each to the entry nearest to it. Then round after round one more corner for
    every entry, its nearest free one: the thesis's "better approach". The order of the atlas has no say.
    """
    corners, _ = lattice.corners(rgb)
    apart = np.linalg.norm(lattice.points[corners] - rgb[:, None, :], axis=-1)
    by_distance = np.argsort(apart, axis=1, kind="stable")
    queue = np.take_along_axis(corners, by_distance, axis=1)
    nearest = np.take_along_axis(apart, by_distance, axis=1)[:, 0]
    order = np.lexsort([*rgb.T, nearest])
    owner, collisions = _share_primaries(queue, order)
    primaries = len(owner)
    for _ in range(8):
        for entry in order:
            free = next((int(point) for point in queue[entry] if point not in owner), None)
            if free is not None:
                owner[free] = int(entry)
    return Seeds(
        points=np.array(list(owner), dtype=np.int64),
        entry=np.array(list(owner.values()), dtype=np.int64),
        primary=np.arange(len(owner)) < primaries,
        collisions=collisions,
    )


def _share_primaries(queue: Indices, order: Indices) -> tuple[dict[int, int], tuple[Collision, ...]]:
    owner: dict[int, int] = {}
    collisions = []
    for entry in order:
        kept = owner.setdefault(int(queue[entry, 0]), int(entry))
        if kept != entry:
            collisions.append(Collision(kept, int(entry)))
    return owner, tuple(collisions)
