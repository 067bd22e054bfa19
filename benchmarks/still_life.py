"""A still life of measured materials: balls on a cloth before a wall, by Mitsuba.

Every pixel is a mixture of reflectances of the materials, scaled by the light that
falls on it, so that its spectrum is known.
"""

import math

import numpy as np

from benchmarks import Row, mitsuba_scenes
from uplift.common.arrays import Array

WIDTH = 480
HEIGHT = 250
SAMPLES = 2
"""Rays along each side of a pixel."""
LIGHT_SAMPLES = 24
"""Rays to lights from where a ray falls."""
EYE = (0.0, -9.0, 3.4)
TARGET = (0.0, 0.0, 0.62)
FOCAL = 2.4
"""Distance of an image that is 2 wide."""
WALL = 2.6
"""Distance of the wall behind the middle of the table."""
TILE = 0.55
BALLS = (
    (-2.75, 0.9, 0.85), (-1.15, 1.5, 1.05), (0.75, 1.3, 0.95), (2.45, 1.2, 0.9),
    (-3.0, -0.9, 0.5), (-1.95, -0.55, 0.6), (-0.75, -0.35, 0.68),
    (0.6, -0.6, 0.58), (1.75, -0.35, 0.66), (2.9, -0.7, 0.52),
    (-2.4, -2.0, 0.36), (-1.35, -1.9, 0.42), (-0.25, -1.95, 0.38),
    (0.8, -1.85, 0.4), (1.9, -1.75, 0.44), (2.75, -1.95, 0.32),
)  # fmt: skip
"""Places (x, y) on the table, and radii."""
MATERIALS = len(BALLS) + 3
"""Materials: of the balls, then two of the cloth, and that of the wall."""
LAMP = (-15.0, -15.0, 22.0)
LAMP_RADIUS = 7.0
AMBIENT = 0.22
"""Share of the light that comes from all around."""


def still_life() -> Array:
    """Weights (HEIGHT, WIDTH, MATERIALS) of the reflectances of all materials in each
    pixel; their sum is at most 1.
    """
    mitsuba_scenes.start_mitsuba("scalar_rgb")
    rays = mitsuba_scenes.render(scene_parts(), 1).reshape(-1, 7)
    shade, _, _, shape, x, y, _ = rays.T
    # Shapes are counted from 1 in the order of the scene; the cloth has two materials.
    number = shape.astype(int) - 1
    cloth = len(BALLS)
    tiles = (np.floor(x / TILE) + np.floor(y / TILE)).astype(int) % 2
    material = number + (number > cloth) + tiles * (number == cloth)
    weights = np.zeros((len(rays), MATERIALS))
    weights[np.arange(len(rays)), material] = np.minimum(shade, 1)
    fine = weights.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, MATERIALS)
    return fine.mean(axis=(1, 3))


def scene_parts() -> Row:
    """Return the scene: all surfaces are white, and reflect no light to each other."""
    from mitsuba import ScalarTransform4f as Transform

    white = mitsuba_scenes.diffuse(grey(1))
    away = math.dist(LAMP, TARGET) / LAMP_RADIUS
    parts: Row = {
        "integrator": {
            "type": "aov",
            "aovs": "shape:shape_index,place:position",
            "shade": {
                "type": "direct",
                "emitter_samples": LIGHT_SAMPLES,
                "bsdf_samples": LIGHT_SAMPLES,
            },
        },
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(2 * math.atan(1 / FOCAL)),
            "to_world": Transform().look_at(EYE, TARGET, (0, 0, 1)),
            "film": mitsuba_scenes.film(WIDTH * SAMPLES, HEIGHT * SAMPLES, "rgb"),
        },
        "around": {"type": "constant", "radiance": grey(AMBIENT)},
    }
    for number, (x, y, radius) in enumerate(BALLS):
        ball = {"type": "sphere", "center": (x, y, radius), "radius": radius}
        parts[f"ball {number}"] = {**ball, "bsdf": white}
    to_wall = Transform().translate((0, WALL, 0)).rotate((1, 0, 0), 90)
    planes = {"cloth": Transform(), "wall": to_wall}
    for name, place in planes.items():
        to_world = place.scale(100)
        parts[name] = {"type": "rectangle", "to_world": to_world, "bsdf": white}
    parts["lamp"] = {
        "type": "sphere",
        "center": LAMP,
        "radius": LAMP_RADIUS,
        "emitter": {"type": "area", "radiance": grey((1 - AMBIENT) * away**2)},
    }
    return parts


def grey(value: float) -> Row:
    """Describe three equal numbers."""
    return mitsuba_scenes.rgb(np.full(3, value))
