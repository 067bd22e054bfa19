"""A picture for any palette: a ball cut open, its layers the materials, and a bead of each below.

The first material is a translucent skin around the others, closed where they are cut: what lies under it shows as
soon as a light turns it black. Layers of equal colour are one until a light parts them. No layer has an edge, an
outline or a gloss of its own, so that what a light hides is hidden.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array

SIZE = 512
"""Pixels a side."""
SKIN = 0.93
"""Radius of what is under the skin, against the skin's."""
CORE = 1.6
"""How many layers thick the innermost is."""
DEPTH = 0.13
"""Optical depth of the skin, looked straight at."""
BALL, RADIUS = (0.0, 0.2), 0.74
"""Where the ball lies in a square of ±1, and how large it is."""
BEADS, BEAD, SPAN, STEP = -0.79, 0.135, 1.76, 0.42
"""Where the row of beads lies, how large a bead is at most, how wide the row, and from bead to bead at most."""
AMBIENT = 0.22
KEY, FILL = (np.array([-0.55, 0.57, 0.61]), 0.68), (np.array([0.75, 0.05, 0.66]), 0.22)
"""Directions that light comes from (x to the right, y up, z to the viewer), and how much."""
YAW, PITCH = np.radians([40, 27])
"""How the cut, which takes away the octant x, y, z > 0, is turned to the viewer."""
CORNER = 0.16
"""How far from an inner edge of the cut it is darker, against the radius."""
OFFSETS = (-0.25, 0.25)
"""Four samples a pixel."""


@dataclass(frozen=True, eq=False)
class _Hits:
    """Where k rays meet something, in radii from its middle, which way it looks, and whether it is a cut."""

    points: Array
    normals: Array
    cut: NDArray[np.bool_]


def cutaway(count: int, size: int = SIZE) -> NDArray[np.float32]:
    """(size, size, count) how much of each material a pixel shows, from 0 to 1."""
    shown = np.zeros((size, size, count), dtype=np.float32)
    steps = (np.arange(size) + 0.5) * 2 / size - 1
    for across in OFFSETS:
        for down in OFFSETS:
            _show(shown, steps + across * 2 / size, -steps - down * 2 / size)
    return shown / np.float32(len(OFFSETS) ** 2)


def _show(shown: NDArray[np.float32], x: Array, y: Array) -> None:
    """Add what rays at the columns ``x`` and the rows ``y`` meet."""
    count = shown.shape[2]
    step = min(SPAN / count, STEP)
    _show_skin(shown, x, y)
    for number in range(count):
        rows, columns, points = _sphere(
            x, y, (step * (number - (count - 1) / 2), BEADS), min(BEAD, STEP * step)
        )
        shown[rows, columns, number] += _shade(points)
    _show_layers(shown, x, y)


def _show_layers(shown: NDArray[np.float32], x: Array, y: Array) -> None:
    """The materials but the first from the outside in, seen through the first; a single one is solid."""
    first = min(1, shown.shape[2] - 1)
    layers = shown.shape[2] - first
    rows, columns, points = _sphere(x, y, BALL, RADIUS * SKIN)
    met, hits = _opened(points)
    depth = (1 - np.linalg.norm(hits.points, axis=1)) * (layers - 1 + CORE)
    layer = np.clip(np.floor(depth + 1e-9).astype(int), 0, layers - 1)
    shade = _shade(hits.normals) * _corners(hits)
    if first:
        across, up = x[columns[met]] - BALL[0], y[rows[met]] - BALL[1]
        shade *= 1 - _veil(np.sqrt(RADIUS**2 - across**2 - up**2) / RADIUS)
    shown[rows[met], columns[met], first + layer] += shade


def _show_skin(shown: NDArray[np.float32], x: Array, y: Array) -> None:
    if shown.shape[2] > 1:
        rows, columns, points = _sphere(x, y, BALL, RADIUS)
        shown[rows, columns, 0] += _veil(points[:, 2]) * _shade(points)


def _veil(cosine: Array) -> Array:
    """How much of what is behind the skin it hides, looked at under this angle."""
    return 1 - np.exp(-DEPTH / np.maximum(cosine, 0.12))


def _sphere(
    x: Array, y: Array, middle: tuple[float, float], radius: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Rows and columns (k,) that see a sphere, and (k, 3) which point of it, in radii; that is its normal too."""
    across, up = (x - middle[0]) / radius, (y - middle[1]) / radius
    square = 1 - across**2 - up[:, None] ** 2
    rows, columns = np.nonzero(square > 0)
    return rows, columns, np.stack([across[columns], up[rows], np.sqrt(square[rows, columns])], axis=1)


def _opened(points: Array) -> tuple[NDArray[np.bool_], _Hits]:
    """A sphere without its octant: rays that enter there go on to one of three walls, or leave it; which do not."""
    axes = _axes()
    turned, way = points @ axes, axes[2]
    cut = np.asarray((turned > 0).all(axis=1))
    steps = turned / way
    behind = turned - steps.min(axis=1, keepdims=True) * way
    met = ~cut | ((behind**2).sum(axis=1) < 1)
    normals = np.where(cut[:, None], axes[:, steps.argmin(axis=1)].T, points)
    return met, _Hits(np.where(cut[:, None], behind, turned)[met], normals[met], cut[met])


def _axes() -> Array:
    """(3, 3) Rows are right, up and to the viewer, in the axes of the cut."""
    (a, b), (c, d) = (np.cos(YAW), np.sin(YAW)), (np.cos(PITCH), np.sin(PITCH))
    return np.array([[a, 0, -b], [-d * b, c, -d * a], [c * b, d, c * a]])


def _shade(normals: Array) -> Array:
    """How bright a matt surface is, at most 1."""
    key, fill = (power * np.maximum(normals @ (way / np.linalg.norm(way)), 0) for way, power in (KEY, FILL))
    return np.minimum(AMBIENT + key + fill, 1)


def _corners(hits: _Hits) -> Array:
    """Less light where walls of the cut meet."""
    dark = np.exp(-np.maximum(hits.points, 0) / CORNER).sum(axis=1) - 1  # a wall is no corner of its own
    return np.where(hits.cut, 1 - 0.3 * np.clip(dark, 0, 2), 1)
