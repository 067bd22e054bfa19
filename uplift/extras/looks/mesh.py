"""Closed meshes of triangles: directions on a sphere, volume, and outline."""

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices

ANGLES = 120
MIN_ROUNDNESS = 1e-12
"""Smallest ratio of the variances along the axes of a shape that is made round."""


@dataclass(frozen=True, eq=False)
class Sphere:
    """Directions as the corners of a triangle mesh."""

    directions: Array
    """(D, 3) Unit vectors; those of coarser meshes come first."""
    faces: Indices
    """(F, 3) Triangles, their corners counter-clockwise from outside."""
    parents: Indices
    """(D,) A neighbour of each direction in the coarser mesh; −1 for the corners of the
    icosahedron.
    """


def sphere(divisions: int) -> Sphere:
    """Divide every triangle of an icosahedron into four, so many times."""
    golden = (1 + 5**0.5) / 2
    signs = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)]) * (1, golden)
    corners = np.concatenate(
        [np.roll(np.pad(signs, ((0, 0), (1, 0))), shift, axis=1) for shift in range(3)]
    )
    triples = (
        np.array(np.meshgrid(*[np.arange(12)] * 3, indexing="ij")).reshape(3, -1).T
    )
    triples = triples[(triples[:, 0] < triples[:, 1]) & (triples[:, 0] < triples[:, 2])]
    a, b, c = (corners[triples[:, column]] for column in range(3))
    near = [
        np.isclose(((p - q) ** 2).sum(axis=1), 4) for p, q in ((a, b), (b, c), (c, a))
    ]
    outwards = np.einsum("ni,ni->n", np.cross(b - a, c - a), a) > 0
    faces = triples[np.logical_and.reduce([*near, outwards])]
    mesh = Sphere(
        corners / np.linalg.norm(corners, axis=1)[:, None], faces, np.full(12, -1)
    )
    for _ in range(divisions):
        mesh = _divided(mesh)
    return mesh


def _divided(coarse: Sphere) -> Sphere:
    """Add the middle of every edge."""
    edges, which = np.unique(_sides(coarse.faces), axis=0, return_inverse=True)
    middles = coarse.directions[edges].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    a, b, c = coarse.faces.T
    ab, bc, ca = (which.reshape(-1, 3) + len(coarse.directions)).T
    faces = np.concatenate(
        [
            np.stack(corners, axis=1)
            for corners in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))
        ]
    )
    return Sphere(
        np.concatenate([coarse.directions, middles]),
        faces,
        np.concatenate([coarse.parents, edges[:, 0]]),
    )


def _sides(faces: Indices) -> Indices:
    """Sides (3 F, 2) of triangles (F, 3), with the lower corner first."""
    sides = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.sort(sides, axis=1)


def mesh_volume(points: Array, faces: Indices) -> Array:
    """Compute the volumes (n,) of closed triangle meshes with corners (n, D, 3) and
    faces (F, 3).
    """
    centred = points - points.mean(axis=1, keepdims=True)
    a, b, c = (centred[:, faces[:, corner]] for corner in range(3))
    return np.einsum("kfi,kfi->k", a, np.cross(b, c)) / 6


def outline(points: Array, faces: Indices, angles: int = ANGLES) -> Array:
    """Compute the outline (angles, 2) of a triangle mesh, of ``faces`` (F, 3), with
    points (D, 2) in a plane.
    """
    centre = points.mean(axis=0)
    values, axes = np.linalg.eigh(np.cov(points.T))
    lengths = np.sqrt(
        np.maximum(values, MIN_ROUNDNESS * values.max() + np.finfo(float).tiny)
    )
    round_points = (points - centre) @ axes / lengths
    turns = np.arange(angles) * (2 * np.pi / angles)
    along, across = (
        np.stack([np.cos(turns + shift), np.sin(turns + shift)])
        for shift in (0.0, np.pi / 2)
    )
    edges = np.unique(_sides(faces), axis=0)
    first, second = (round_points[edges[:, end]] for end in (0, 1))
    side_1 = first @ across
    side_2 = second @ across
    crosses = (side_1 <= 0) != (side_2 <= 0)
    share = np.divide(side_1, side_1 - side_2, out=np.zeros_like(side_1), where=crosses)
    radius = np.where(
        crosses, first @ along + share * ((second - first) @ along), 0
    ).max(axis=0)
    return centre + (radius[:, None] * along.T * lengths) @ axes.T
