"""Which colours a reflectance can have: the object-colour solid.

MacAdam 1935, "The theory of the maximum visual efficiency of colored materials". Reflectances from 0 to 1 at N
wavelengths fill a zonotope of linear RGB, the sum of N segments from black to W_i. Any two of the segments span a
pair of its facets, so it is known exactly. numpy alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Mask

SLACK = 1e-9
"""Linear RGB by which rounding may take a colour out of the solid."""
BLOCK = 1 << 12
"""Colours worked on at a time."""


@dataclass(frozen=True, eq=False)
class Solid:
    """Colours x with ``normals`` (F, 3) · x ≤ ``offsets`` (F,)."""

    normals: Array
    offsets: Array

    def outside(self, rgb: Array) -> Array:
        """How far (n,) linear RGB (n, 3) lie beyond the farthest facet; not positive inside."""
        blocks = [rgb[first : first + BLOCK] for first in range(0, len(rgb), BLOCK)]
        return np.concatenate(
            [np.zeros(0), *((block @ self.normals.T - self.offsets).max(axis=1) for block in blocks)]
        )

    def holds(self, rgb: Array) -> Mask:
        """Whether (n,) some reflectance has linear RGB (n, 3)."""
        return np.asarray(self.outside(rgb) <= SLACK)

    def reach(self, origin: Array, target: Array) -> Array:
        """How much (n,) of the way from ``origin`` (n, 3), which is inside, to ``target`` (n, 3) is: 0 to 1."""
        shares = [np.zeros(0)]
        for first in range(0, len(target), BLOCK):
            here, there = origin[first : first + BLOCK], target[first : first + BLOCK]
            room = np.maximum(self.offsets - here @ self.normals.T, 0)
            speed = (there - here) @ self.normals.T
            shares.append(np.divide(room, speed, out=np.ones_like(room), where=speed > room).min(axis=1))
        return np.concatenate(shares)


def solid(matrix: Array) -> Solid:
    """The solid of a sensor's ``matrix`` (3, N)."""
    segments = matrix.T
    first, second = np.triu_indices(len(segments), k=1)
    across = np.cross(segments[first], segments[second])
    length = np.linalg.norm(across, axis=1)
    kept = length > 1e-12 * np.linalg.norm(segments[first], axis=1) * np.linalg.norm(segments[second], axis=1)
    normals = across[kept] / length[kept, None]
    along = normals @ matrix
    offsets = np.maximum(along, 0).sum(axis=1), np.maximum(-along, 0).sum(axis=1)
    return Solid(np.concatenate([normals, -normals]), np.concatenate(offsets))
