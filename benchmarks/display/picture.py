"""Spheres of colours outside sRGB under a bright light, as each method maps them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, conversion, map_to_gamut
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.viz.figure import new_figure, write_png

REC_2020 = Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
MAPPINGS = tuple(method for method in METHODS if method != "error")
RADIUS = 43
"""Pixels."""
HUES = (
    (1, 0, 0),
    (1, 0.45, 0),
    (0.9, 0.9, 0),
    (0, 1, 0),
    (0, 0.9, 0.9),
    (0, 0.25, 1),
    (0, 0, 1),
    (0.8, 0, 0.9),
)
"""Linear Rec. 2020 of the spheres."""
LIGHT, HIGHLIGHT = 1.3, 3.0


def draw(path: Path) -> None:
    """Write the picture: one column per method, spheres above, all hues from dark to too bright below."""
    figure = new_figure(15, 3.4)
    rows = [spheres(), sweep()]
    grid = figure.subplots(2, len(MAPPINGS), gridspec_kw={"height_ratios": [len(row) for row in rows]})
    for column, method in enumerate(MAPPINGS):
        grid[0, column].set_title(method, fontsize=17, pad=8)
        for axes, image in zip(grid[:, column], rows, strict=True):
            axes.imshow(encode(map_to_gamut(image, SRGB, method).rgb), interpolation="antialiased")
            axes.set_axis_off()
    write_png(figure, path, force=True)


def spheres() -> Array:
    """Return linear sRGB (h, w, 3), partly outside [0, 1]: paint with highlights in the colour of the light."""
    side = 2 * RADIUS + 8
    y, x = np.mgrid[:side, :side] - (side - 1) / 2
    inside = x**2 + y**2 < RADIUS**2
    z = np.sqrt(np.maximum(RADIUS**2 - x**2 - y**2, 0))
    normal = np.stack([x, y, z], axis=-1) / RADIUS
    to_light = np.array([-0.5, -0.6, 0.62])
    facing = np.maximum(normal @ (to_light / np.linalg.norm(to_light)), 0)
    half = to_light / np.linalg.norm(to_light) + [0, 0, 1]
    shine = HIGHLIGHT * np.maximum(normal @ (half / np.linalg.norm(half)), 0) ** 60
    tiles = []
    for hue in HUES:
        lit = np.array(hue) * (0.04 + LIGHT * facing)[..., None] + shine[..., None]
        tiles.append(np.where(inside[..., None], lit, 0.18))
    across = [np.concatenate(tiles[row : row + 4], axis=1) for row in (0, 4)]
    return np.concatenate(across) @ conversion(REC_2020, SRGB).T


def sweep() -> Array:
    """Return linear sRGB (h, w, 3): hues of Rec. 2020 from left to right, brighter upwards, up to three times white."""
    height, width = 2 * RADIUS, 8 * RADIUS + 32
    hue = np.linspace(0, 6, width)
    pure = np.clip(np.abs((hue[:, None] + [3, 1, 5]) % 6 - 3) - 1, 0, 1)
    bright = np.geomspace(3, 0.02, height)
    return (bright[:, None, None] * pure) @ conversion(REC_2020, SRGB).T
