"""Default picture of a palette: an opened ball whose layers are the materials, above a bead of each material.

The first material is a translucent skin around the others, so that inner layers become visible where a light turns it
black. Layers of equal colour merge until a light separates them. No layer has an outline or a highlight, so that a
light can hide it completely.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array

SIZE = 512
"""Pixels along each side."""
SKIN = 0.93
"""Radius of the layers below the skin, relative to the skin."""
CORE = 1.6
"""Thickness of the innermost layer in layers."""
DEPTH = 0.13
"""Optical depth of the skin at normal incidence."""
BALL, RADIUS = (0.0, 0.2), 0.74
"""Centre and radius of the ball in a square of ±1."""
BEADS, BEAD, SPAN, STEP = -0.79, 0.135, 1.76, 0.42
"""Height of the row of beads, largest radius, width of the row, and largest distance between beads."""
AMBIENT = 0.22
KEY, FILL = (np.array([-0.55, 0.57, 0.61]), 0.68), (np.array([0.75, 0.05, 0.66]), 0.22)
"""Directions of two lights (x right, y up, z to the viewer), and their strengths."""
YAW, PITCH = np.radians([40, 27])
"""Rotation of the removed octant x, y, z > 0 towards the viewer."""
CORNER = 0.16
"""Width of the darkening along inner edges of the cut, relative to the radius."""
OFFSETS = (-0.25, 0.25)
"""Subpixel positions, four samples per pixel."""


@dataclass(frozen=True, eq=False)
class _Hits:
    """Intersections of k rays: positions in radii from the centre, normals, and whether they lie on the cut."""

    points: Array
    normals: Array
    cut: NDArray[np.bool_]


def cutaway(count: int, size: int = SIZE) -> NDArray[np.float32]:
    """Render the picture.

    Parameters
    ----------
    count : int
        Number of materials, 1 or more.
    size : int
        Pixels along each side.

    Returns
    -------
    ndarray, shape (size, size, count)
        Amount of each material in each pixel, in [0, 1].
    """
    weights = np.zeros((size, size, count), dtype=np.float32)
    steps = (np.arange(size) + 0.5) * 2 / size - 1
    for dx in OFFSETS:
        for dy in OFFSETS:
            _add_samples(weights, steps + dx * 2 / size, -steps - dy * 2 / size)
    return weights / np.float32(len(OFFSETS) ** 2)


def _add_samples(weights: NDArray[np.float32], x: Array, y: Array) -> None:
    """Add the samples at columns ``x`` and rows ``y``."""
    count = weights.shape[2]
    step = min(SPAN / count, STEP)
    _add_skin(weights, x, y)
    for number in range(count):
        rows, columns, points = _intersect_sphere(
            x, y, (step * (number - (count - 1) / 2), BEADS), min(BEAD, STEP * step)
        )
        weights[rows, columns, number] += _shade(points)
    _add_layers(weights, x, y)


def _add_layers(weights: NDArray[np.float32], x: Array, y: Array) -> None:
    """Add all materials but the first from the outside in, attenuated by the first; a single one is solid."""
    first = min(1, weights.shape[2] - 1)
    layers = weights.shape[2] - first
    rows, columns, points = _intersect_sphere(x, y, BALL, RADIUS * SKIN)
    met, hits = _intersect_opened(points)
    depth = (1 - np.linalg.norm(hits.points, axis=1)) * (layers - 1 + CORE)
    layer = np.clip(np.floor(depth + 1e-9).astype(int), 0, layers - 1)
    shade = _shade(hits.normals) * _corner_darkening(hits)
    if first:
        dx, dy = x[columns[met]] - BALL[0], y[rows[met]] - BALL[1]
        shade *= 1 - _opacity(np.sqrt(RADIUS**2 - dx**2 - dy**2) / RADIUS)
    weights[rows[met], columns[met], first + layer] += shade


def _add_skin(weights: NDArray[np.float32], x: Array, y: Array) -> None:
    if weights.shape[2] > 1:
        rows, columns, points = _intersect_sphere(x, y, BALL, RADIUS)
        weights[rows, columns, 0] += _opacity(points[:, 2]) * _shade(points)


def _opacity(cosine: Array) -> Array:
    """Opacity of the skin at the cosine of an angle of incidence."""
    return 1 - np.exp(-DEPTH / np.maximum(cosine, 0.12))


def _intersect_sphere(
    x: Array, y: Array, centre: tuple[float, float], radius: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Rows and columns (k,) of the samples on a sphere, and its normals (k, 3) there."""
    dx, dy = (x - centre[0]) / radius, (y - centre[1]) / radius
    square = 1 - dx**2 - dy[:, None] ** 2
    rows, columns = np.nonzero(square > 0)
    return rows, columns, np.stack([dx[columns], dy[rows], np.sqrt(square[rows, columns])], axis=1)


def _intersect_opened(points: Array) -> tuple[NDArray[np.bool_], _Hits]:
    """Intersect the sphere without its octant: rays that enter there reach one of three walls, or leave it.

    The mask marks the rays that do not leave it.
    """
    axes = _axes()
    rotated, direction = points @ axes, axes[2]
    cut = np.asarray((rotated > 0).all(axis=1))
    steps = rotated / direction
    wall_point = rotated - steps.min(axis=1, keepdims=True) * direction
    met = ~cut | ((wall_point**2).sum(axis=1) < 1)
    normals = np.where(cut[:, None], axes[:, steps.argmin(axis=1)].T, points)
    return met, _Hits(np.where(cut[:, None], wall_point, rotated)[met], normals[met], cut[met])


def _axes() -> Array:
    """Rotation (3, 3): rows are right, up and to the viewer in the axes of the cut."""
    (a, b), (c, d) = (np.cos(YAW), np.sin(YAW)), (np.cos(PITCH), np.sin(PITCH))
    return np.array([[a, 0, -b], [-d * b, c, -d * a], [c * b, d, c * a]])


def _shade(normals: Array) -> Array:
    """Brightness of a matt surface, at most 1."""
    key, fill = (
        power * np.maximum(normals @ (direction / np.linalg.norm(direction)), 0) for direction, power in (KEY, FILL)
    )
    return np.minimum(AMBIENT + key + fill, 1)


def _corner_darkening(hits: _Hits) -> Array:
    """Darkening where walls of the cut meet."""
    dark = np.exp(-np.maximum(hits.points, 0) / CORNER).sum(axis=1) - 1  # 1 is the wall itself
    return np.where(hits.cut, 1 - 0.3 * np.clip(dark, 0, 2), 1)
