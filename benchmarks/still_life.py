"""A still life of measured materials: balls on a cloth before a wall, cast by rays.

Every pixel is a mixture of reflectances of the materials, scaled by the light that
falls on it, so that its spectrum is known.
"""

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices, Mask

WIDTH = 480
HEIGHT = 250
SAMPLES = 2
"""Rays along each side of a pixel."""
EYE = np.array([0.0, -9.0, 3.4])
TARGET = np.array([0.0, 0.0, 0.62])
FOCAL = 2.4
"""Distance of an image that is 2 wide."""
WALL = 2.6
"""Distance of the wall behind the middle of the table."""
TILE = 0.55
BALLS = np.array(
    [
        (-2.75, 0.9, 0.85), (-1.15, 1.5, 1.05), (0.75, 1.3, 0.95), (2.45, 1.2, 0.9),
        (-3.0, -0.9, 0.5), (-1.95, -0.55, 0.6), (-0.75, -0.35, 0.68),
        (0.6, -0.6, 0.58), (1.75, -0.35, 0.66), (2.9, -0.7, 0.52),
        (-2.4, -2.0, 0.36), (-1.35, -1.9, 0.42), (-0.25, -1.95, 0.38),
        (0.8, -1.85, 0.4), (1.9, -1.75, 0.44), (2.75, -1.95, 0.32),
    ]
)  # fmt: skip
"""Places (x, y) on the table, and radii."""
MATERIALS = len(BALLS) + 3
"""Materials: of the balls, then two of the cloth, and that of the wall."""
LAMP = np.array([-0.55, -0.55, 0.8])
"""Direction to the middle of the light."""
LAMP_SIZE = 0.3
LAMP_RAYS = 24
AMBIENT = 0.22
EPSILON = 1e-3


@dataclass(frozen=True, eq=False)
class Hits:
    """What n rays hit: points (n, 3), unit normals (n, 3), and materials (n,)."""

    points: Array
    normals: Array
    material: Indices


def still_life() -> Array:
    """Weights (HEIGHT, WIDTH, MATERIALS) of the reflectances of all materials in each
    pixel; their sum is at most 1.
    """
    hits = cast(rays())
    shade = lit(hits)
    weights = np.zeros((len(shade), MATERIALS))
    weights[np.arange(len(shade)), hits.material] = shade
    fine = weights.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, MATERIALS)
    return fine.mean(axis=(1, 3))


def rays() -> Array:
    """Return unit directions (n, 3) from the eye through all samples of the image."""
    forward = TARGET - EYE
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    columns = (np.arange(WIDTH * SAMPLES) + 0.5) / (WIDTH * SAMPLES) * 2 - 1
    rows = (np.arange(HEIGHT * SAMPLES) + 0.5) / (HEIGHT * SAMPLES) * 2 - 1
    y, x = np.meshgrid(-rows * HEIGHT / WIDTH, columns, indexing="ij")
    directions = FOCAL * forward + x[..., None] * right + y[..., None] * up
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return directions.reshape(-1, 3)


def cast(directions: Array) -> Hits:
    """Find what rays from the eye hit."""
    to_table = np.where(directions[:, 2] < 0, -EYE[2] / directions[:, 2], np.inf)
    to_wall = (WALL - EYE[1]) / directions[:, 1]
    is_wall = to_wall < to_table
    nearest = np.minimum(to_table, to_wall)
    points = EYE + nearest[:, None] * directions
    normals = np.where(is_wall[:, None], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0])
    tiles = np.floor(points[:, :2] / TILE).astype(int).sum(axis=1) % 2
    material = np.where(is_wall, MATERIALS - 1, len(BALLS) + tiles)
    for number, (x, y, radius) in enumerate(BALLS):
        centre = np.array([x, y, radius])
        distance = to_ball(EYE - centre, directions, radius)
        rows = distance < nearest
        nearest[rows] = distance[rows]
        points[rows] = EYE + distance[rows, None] * directions[rows]
        normals[rows] = (points[rows] - centre) / radius
        material[rows] = number
    return Hits(points, normals, material)


def to_ball(origins: Array, directions: Array, radius: float) -> Array:
    """Distances (n,) along rays to a ball around the origin, inf for those that pass
    it.
    """
    along = (origins * directions).sum(axis=-1)
    discriminant = along**2 - (origins**2).sum(axis=-1) + radius**2
    distance = -along - np.sqrt(np.maximum(discriminant, 0))
    return np.where((discriminant > 0) & (distance > 0), distance, np.inf)


def lit(hits: Hits) -> Array:
    """Light (n,) in [0, 1] that falls on what was hit: of a round lamp, and of all
    around.
    """
    random = np.random.default_rng(0)
    direct = np.zeros(len(hits.points))
    for offset in random.normal(size=(LAMP_RAYS, 3)):
        towards = LAMP + LAMP_SIZE * offset / np.linalg.norm(offset)
        towards /= np.linalg.norm(towards)
        facing = np.maximum(hits.normals @ towards, 0)
        direct += np.where(in_shadow(hits, towards), 0, facing) / LAMP_RAYS
    sky = 0.5 + 0.5 * hits.normals[:, 2]
    return np.minimum((1 - AMBIENT) * direct + AMBIENT * sky, 1)


def in_shadow(hits: Hits, towards: Array) -> Mask:
    """Whether a ball lies between what was hit and the light in a direction (3,)."""
    origins = hits.points + EPSILON * hits.normals
    directions = np.broadcast_to(towards, origins.shape)
    shadow = np.zeros(len(origins), dtype=bool)
    for x, y, radius in BALLS:
        centre = np.array([x, y, radius])
        shadow |= np.isfinite(to_ball(origins - centre, directions, radius))
    return shadow
