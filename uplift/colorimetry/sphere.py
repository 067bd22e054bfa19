"""Directions spread over the sphere: an icosahedron whose triangles are divided into four."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices

COUNTS = (12, 42, 162, 642, 2562)
"""Directions after 0 to 4 divisions."""


@dataclass(frozen=True, eq=False)
class Sphere:
    """Directions as the corners of a triangle mesh."""

    directions: Array
    """(D, 3) Unit vectors; those of coarser meshes come first."""
    faces: Indices
    """(F, 3) Triangles, their corners counter-clockwise from outside."""
    parents: Indices
    """(D,) A neighbour of each direction in the coarser mesh; −1 for the corners of the icosahedron."""


def sphere(divisions: int) -> Sphere:
    """Divide the icosahedron."""
    found = _icosahedron()
    for _ in range(divisions):
        found = _divided(found)
    return found


def _icosahedron() -> Sphere:
    golden = (1 + 5**0.5) / 2
    signs = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)]) * (1, golden)
    corners = np.concatenate([np.roll(np.pad(signs, ((0, 0), (1, 0))), shift, axis=1) for shift in range(3)])
    triples = np.array(np.meshgrid(*[np.arange(12)] * 3, indexing="ij")).reshape(3, -1).T
    triples = triples[(triples[:, 0] < triples[:, 1]) & (triples[:, 0] < triples[:, 2])]
    a, b, c = (corners[triples[:, column]] for column in range(3))
    near = [np.isclose(((p - q) ** 2).sum(axis=1), 4) for p, q in ((a, b), (b, c), (c, a))]
    outwards = np.einsum("ni,ni->n", np.cross(b - a, c - a), a) > 0
    faces = triples[np.logical_and.reduce([*near, outwards])]
    return Sphere(corners / np.linalg.norm(corners, axis=1)[:, None], faces, np.full(12, -1))


def _divided(coarse: Sphere) -> Sphere:
    """Add the middle of every edge."""
    edges = np.sort(coarse.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, which = np.unique(edges, axis=0, return_inverse=True)
    middles = coarse.directions[edges].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    (a, b, c), (ab, bc, ca) = coarse.faces.T, (which.reshape(-1, 3) + len(coarse.directions)).T
    faces = np.concatenate([np.stack(each, axis=1) for each in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return Sphere(np.concatenate([coarse.directions, middles]), faces, np.concatenate([coarse.parents, edges[:, 0]]))
