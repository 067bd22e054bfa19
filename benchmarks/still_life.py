"""A still life of measured materials: balls on a cloth before a wall, by Mitsuba.

Every pixel is a mixture of reflectances of the materials, scaled by the light that
falls on it, so that its spectrum is known.
"""

import math
from typing import Any

import numpy as np

from benchmarks import Row
from uplift.common.arrays import Array, Indices

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
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    parts = scene_parts(mitsuba.ScalarTransform4f())
    scene = mitsuba.load_dict(parts, optimize=False)  # which would join rectangles
    rays = np.array(mitsuba.render(scene, spp=1, seed=0)).reshape(-1, 7)
    shade, _, _, shape, *place = rays.T
    material = materials_of([part.id() for part in scene.shapes()], shape, place)
    weights = np.zeros((len(rays), MATERIALS))
    weights[np.arange(len(rays)), material] = np.minimum(shade, 1)
    fine = weights.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, MATERIALS)
    return fine.mean(axis=(1, 3))


def materials_of(names: list[str], shape: Array, place: list[Array]) -> Indices:
    """Return the materials (n,) of shapes (n,), which are counted from 1; the cloth has
    tiles by the place.
    """
    numbers = np.array([int(name.partition("-")[2] or -1) for name in names])
    material = numbers[shape.astype(int) - 1]
    x, y, _ = place
    tiles = (np.floor(x / TILE) + np.floor(y / TILE)).astype(int) % 2
    return material + tiles * (material == len(BALLS))


def scene_parts(transform: Any) -> Row:
    """Return the scene: all surfaces are white, and reflect no light to each other."""
    white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}
    away = math.dist(LAMP, TARGET) / LAMP_RADIUS
    parts = {
        "type": "scene",
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
            "to_world": transform.look_at(EYE, TARGET, (0, 0, 1)),
            "film": {
                "type": "hdrfilm",
                "width": WIDTH * SAMPLES,
                "height": HEIGHT * SAMPLES,
                "rfilter": {"type": "box"},
                "pixel_format": "rgb",
            },
        },
        "around": {
            "type": "constant",
            "radiance": {"type": "rgb", "value": AMBIENT},
        },
        "lamp": {
            "type": "sphere",
            "center": LAMP,
            "radius": LAMP_RADIUS,
            "emitter": {
                "type": "area",
                "radiance": {"type": "rgb", "value": (1 - AMBIENT) * away**2},
            },
        },
        f"cloth-{len(BALLS)}": {
            "type": "rectangle",
            "to_world": transform.scale(100),
            "bsdf": white,
        },
        f"wall-{MATERIALS - 1}": {
            "type": "rectangle",
            "to_world": transform.translate((0, WALL, 0))
            .rotate((1, 0, 0), 90)
            .scale(100),
            "bsdf": white,
        },
    }
    for number, (x, y, radius) in enumerate(BALLS):
        ball = {"type": "sphere", "center": (x, y, radius), "radius": radius}
        parts[f"ball-{number}"] = {**ball, "bsdf": white}
    return parts
