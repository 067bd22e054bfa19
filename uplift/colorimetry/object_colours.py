"""The object-colour solid: all colours that a reflectance in [0, 1] can have.

MacAdam 1935, "The theory of the maximum visual efficiency of colored materials".
Reflectances in [0, 1] at N wavelengths map to a zonotope of linear RGB, the sum of N
segments from black to W_i. Each pair of segments spans two parallel facets, so the
facets are known exactly.
"""

import functools
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Mask, blocks

SLACK = 1e-9
"""Distance from the solid, in linear RGB, that counts as rounding."""
BLOCK = 1 << 6
"""Colours processed per block: with thousands of facets, larger arrays do not fit into
the cache.
"""
BLOCK_FACETS = 1 << 10
"""Facets whose offsets are computed at once."""


@dataclass(frozen=True, eq=False)
class Solid:
    """Convex polyhedron of the colours x with ``normals @ x <= offsets``."""

    normals: Array
    """(F, 3) Outward unit normals of the facets."""
    offsets: Array
    """(F,) Distances of the facets from the origin."""

    def signed_distance(self, rgb: Array) -> Array:
        """Compute the largest signed distance (n,) of linear RGB (n, 3) from the
        facets: positive outside the solid.
        """
        distances = [np.zeros(0)]
        for block in blocks(len(rgb), BLOCK):
            apart = rgb[block] @ self.normals.T - self.offsets
            distances.append(apart.max(axis=1))
        return np.concatenate(distances)

    def contains(self, rgb: Array) -> Mask:
        """Test whether (n,) a reflectance with each linear RGB (n, 3) exists."""
        return self.signed_distance(rgb) <= SLACK

    def ray_fraction(self, origin: Array, target: Array) -> Array:
        """Compute the fraction (n,) that is inside the solid of segments from an origin
        (n, 3) inside to a target.
        """
        fractions = [np.zeros(0)]
        for block in blocks(len(target), BLOCK):
            start = origin[block]
            end = target[block]
            # On start + f · (end − start), facet i is met at f = (offset_i − n_i ·
            # start) / n_i · (end − start).
            margin = np.maximum(self.offsets - start @ self.normals.T, 0)
            speed = (end - start) @ self.normals.T
            fraction = np.ones_like(margin)
            np.divide(margin, speed, out=fraction, where=speed > margin)
            fractions.append(fraction.min(axis=1))
        return np.concatenate(fractions)


def toward_grey(limits: Solid, grey: Array, target: Array, margin: float) -> Array:
    """Move colours (n, 3) that lie outside the solid, or less than a margin inside,
    onto their line to a grey (n, 3).

    Colours deeper inside are unchanged, bit for bit, and the result is continuous.
    """
    result = target.copy()
    near = np.flatnonzero(limits.signed_distance(target) > -2 * margin)
    grey, chroma = grey[near], target[near] - grey[near]
    # With x = grey + f · chroma, the boundary is at f = 2 · ray_fraction; results stay
    # a margin inside of it.
    inward = margin / np.maximum(np.abs(chroma).max(axis=1), margin)
    reach = 2 * limits.ray_fraction(grey, grey + 2 * chroma) - inward
    moved = reach < 1
    result[near[moved]] = (grey + np.maximum(reach, 0)[:, None] * chroma)[moved]
    return result


def solid(matrix: Array) -> Solid:
    """Compute the object-colour solid of a sensor. Shapes: ``matrix`` (3, N).

    Of the last few sensors it is kept, as a build needs it several times.
    """
    return _solid(np.ascontiguousarray(matrix, dtype=float).tobytes())


@functools.lru_cache(maxsize=4)
def _solid(matrix_bytes: bytes) -> Solid:
    matrix = np.frombuffer(matrix_bytes).reshape(3, -1)
    # The zonotope is Σ_i [0, 1] · W_i. A facet is spanned by two segments: its normal
    # is n = ± W_i × W_j.
    segments = matrix.T
    first, second = np.triu_indices(len(segments), k=1)
    cross = np.cross(segments[first], segments[second])
    length = np.linalg.norm(cross, axis=1)
    kept = length > 1e-12 * np.linalg.norm(segments[first], axis=1) * np.linalg.norm(
        segments[second], axis=1
    )
    normals = cross[kept] / length[kept, None]
    # The farthest colour along n takes every W_k with n · W_k > 0: the offset is Σ_k
    # max(0, n · W_k).
    along = normals @ matrix
    upper = np.empty(len(normals))
    lower = np.empty(len(normals))
    for block in blocks(len(normals), BLOCK_FACETS):
        upper[block] = np.maximum(along[block], 0).sum(axis=1)
        lower[block] = np.maximum(-along[block], 0).sum(axis=1)
    found = Solid(np.concatenate([normals, -normals]), np.concatenate([upper, lower]))
    found.normals.setflags(write=False)
    found.offsets.setflags(write=False)
    return found
