"""Make the sample files of uplift/samples that are pictures or measurements: ``make samples``; commit the result.

The pictures are computed here, from colours of the ColorChecker, and are in the public domain (CC0). The output is the
same on every run.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray
from PIL import Image

from tests.atlas.vendor_files import argyll_ti3, cxf3, plain_csv, xlsx
from uplift.atlas import Atlas, on_grid, read_atlas, write_atlas
from uplift.colorimetry.observer import sensor
from uplift.colorimetry.srgb import decode, encode
from uplift.common.arrays import Array
from uplift.samples.copy_samples import FOLDER

WIDTH, HEIGHT = 480, 272
HORIZON = 0.48
"""Height of the far edge of the table, as a share of the picture's."""
LIGHT = np.array([-0.55, -0.62, 0.56]) / np.linalg.norm([-0.55, -0.62, 0.56])
"""Direction to the lamp: x to the right, y down, z to the viewer."""
AMBIENT = 0.16
BALLS = (
    ("blue", 92, 128, 50),
    ("bluish green", 372, 110, 38),
    ("purple", 318, 138, 44),
    ("yellow", 178, 142, 46),
    ("foliage", 30, 174, 34),
    ("orange", 252, 168, 48),
    ("red", 136, 198, 42),
    ("yellow green", 204, 218, 30),
    ("magenta", 70, 220, 30),
)
"""Colour, centre in pixels and radius of each ball, the farthest first."""
CARD = (342, 178, 20, 2)
"""Left, top, size of a patch and gap of the colour chart on the table, in pixels."""
MEASUREMENTS = {"paints.csv": "macbeth", "fabrics.csv": "pmc"}
"""Shipped atlases that stand for measurements of the reader."""


def main(folder: Path = FOLDER) -> None:
    """Write all files."""
    picture = still_life()
    write_png(picture, folder / "still-life.png")
    write_png(planks(), folder / "wood.png")
    Image.fromarray(knot()).save(folder / "mask.png", optimize=True)
    for frame, left in enumerate((60, 96), 1):
        write_exr(picture[92:252:2, left : left + 240 : 2], folder / f"shot.{frame:04}.exr")
    for tile, half in zip((1001, 1002), np.split(planks(), 2, axis=1), strict=True):
        write_exr(half[::2, ::2], folder / f"tile.{tile}.exr")
    write_exr(picture[::4, ::4], folder / "painting.exr")
    write_exr(fire(), folder / "fire.exr")
    write_exr(sky(), folder / "sky.exr")
    write_png(label(), folder / "labels.png")
    for name, atlas in MEASUREMENTS.items():
        write_atlas(read_atlas(atlas), folder / name, force=True)
    for name, content in instrument_files().items():
        (folder / name).write_bytes(content)


def instrument_files() -> dict[str, bytes]:
    """Return measurements of the reader as his instruments write them, and samples that reflect less than 2 %."""
    paints, fabrics = (tuple(read_atlas(name)) for name in MEASUREMENTS.values())
    chart = Atlas(tuple(replace(entry, name=f"chart {entry.name}") for entry in paints[:6]))
    dark = Atlas(tuple(replace(entry, values=entry.values * (1.5 / entry.values.max())) for entry in fabrics[:4]))
    ((_, ti3),) = argyll_ti3(chart).items()
    ((_, csv),) = plain_csv(dark).items()
    return {"chart.ti3": ti3, **cxf3(Atlas(paints[:12])), **xlsx(Atlas(paints[:12])), "dark.csv": csv}


def palette() -> dict[str, Array]:
    """Return linear RGB (3,) of the patches of the ColorChecker, clipped to sRGB."""
    eye, atlas = sensor(), read_atlas("macbeth")
    rgb = np.clip(eye.rgb(on_grid(atlas, eye.wavelengths)), 0, 1)
    return dict(zip(atlas.names, rgb, strict=True))


def still_life() -> Array:
    """Return linear RGB (HEIGHT, WIDTH, 3) of painted balls and a colour chart on a table."""
    paint = palette()
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    picture = _room(paint, x, y)
    for _, left, top, radius in BALLS:
        picture *= 1 - 0.62 * _shadow(x - left - 0.42 * radius, y - top - 0.86 * radius, radius)[..., None]
    for name, left, top, radius in BALLS:
        _draw_ball(picture, paint[name], (x - left) / radius, (y - top) / radius)
    _draw_card(picture, paint)
    return picture


def _room(paint: dict[str, Array], x: Array, y: Array) -> Array:
    """Return a wall that is lit from the left, and a table of boards."""
    edge = HORIZON * HEIGHT
    fall = np.clip(1.12 - 0.75 * x / WIDTH - 0.25 * y / HEIGHT, 0, 1)[..., None]
    wall = fall * (0.7 * paint["light skin"] + 0.3 * paint["neutral 8 (.23 D)"])
    return np.where((y < edge)[..., None], wall, _wood(paint, x, (y - edge) / (HEIGHT - edge)))


def _wood(paint: dict[str, Array], x: Array, depth: Array) -> Array:
    far = np.clip(depth, 0, None) ** 0.7
    board = np.floor(5 * far)
    grain = np.sin(90 * far + 3 * np.sin(x / 57 + 2.1 * board) + board) * np.sin(x / 210 + 1.7 * board)
    tone = np.clip(0.42 + 0.10 * np.sin(2.6 * board) + 0.13 * grain - 0.14 * x / WIDTH, 0, 1)[..., None]
    return (1 - tone) * paint["dark skin"] + tone * 0.8 * paint["light skin"]


def _shadow(x: Array, y: Array, radius: float) -> Array:
    """Return how dark the shadow of a ball is, from 0 to 1."""
    distance = np.hypot(x / (1.25 * radius), y / (0.36 * radius))
    return np.clip(1.35 - distance, 0, 1) ** 1.3 * (y > -radius * 0.5)


def _draw_ball(picture: Array, colour: Array, x: Array, y: Array) -> None:
    """Draw a ball of radius 1 with a matt coat of paint and a dull highlight."""
    square = x**2 + y**2
    inside = square < 1
    z = np.sqrt(np.where(inside, 1 - square, 0))
    normal = np.stack([x, y, z], axis=-1)
    lit = AMBIENT + (1 - AMBIENT) * np.clip(normal @ LIGHT, 0, 1)
    half = LIGHT + np.array([0, 0, 1])
    gloss = 0.28 * np.clip(normal @ (half / np.linalg.norm(half)), 0, 1) ** 40
    ball = lit[..., None] * colour * (1 - gloss[..., None]) + gloss[..., None]
    edge = np.clip((1 - np.sqrt(square)) / np.abs(x[0, 1] - x[0, 0]), 0, 1)[..., None]
    picture[:] = edge * ball + (1 - edge) * picture


def _draw_card(picture: Array, paint: dict[str, Array]) -> None:
    """Draw the chart: flat patches in exactly the colours of the atlas."""
    left, top, size, gap = CARD
    pitch = size + gap
    picture[top - gap : top + 4 * pitch, left - gap : left + 6 * pitch] = 0.02
    for number, colour in enumerate(paint.values()):
        row, column = divmod(number, 6)
        y, x = top + row * pitch, left + column * pitch
        picture[y : y + size, x : x + size] = colour


def planks() -> Array:
    """Return linear RGB (96, 128, 3) of boards from above."""
    y, x = np.mgrid[:96, :128] + 0.5
    return _wood(palette(), 4 * x, y / 96)


def knot() -> NDArray[np.uint8]:
    """Return weights (96, 128) from 0 to 255: a disc with a soft edge, as a mask of the boards."""
    y, x = np.mgrid[:96, :128] + 0.5
    return np.rint(255 * np.clip((36 - np.hypot(x - 64, y - 48)) / 8, 0, 1)).astype(np.uint8)


def sky() -> Array:
    """Return an environment map, linear RGB (32, 64, 3): sky, a warm horizon, a sun of up to 4e4, and a street lamp."""
    row, column = np.mgrid[:32, :64] + 0.5
    height, turn = np.pi * (0.5 - row / 32), 2 * np.pi * (column / 64)
    rise = np.clip(np.sin(height), 0, 1)[..., None]
    above = (1 - rise) ** 3 * np.array([1.1, 0.7, 0.4]) + rise**0.5 * np.array([0.16, 0.3, 0.8])
    picture = np.where(height[..., None] > 0, above, np.array([0.05, 0.045, 0.04]))
    picture += _glow(height - 0.45, turn - 1.6, 0.03) * np.array([4e4, 3.4e4, 2.2e4])
    return picture + _glow(height - 0.2, turn - 4.4, 0.05) * np.array([260.0, 95.0, -6.0])


def _glow(up: Array, aside: Array, size: float) -> Array:
    """Return a soft disc (h, w, 1) around an angle, 1 in the middle."""
    return np.exp(-(up**2 + aside**2) / (2 * size**2))[..., None]


def fire() -> Array:
    """Return linear RGB (48, 64, 3) of a flame, up to 4."""
    y, x = np.mgrid[:48, :64] / np.array([48, 64])[:, None, None]
    heat = 4 * np.exp(-(((x - 0.5 + 0.05 * np.sin(9 * y)) / (0.05 + 0.16 * y)) ** 2)) * y
    return heat[..., None] ** np.array([1.0, 1.6, 2.6]) * [1.0, 0.55, 0.2] + 0.004


def label() -> Array:
    """Return linear RGB (128, 128, 3) of a disc in ``#ff8000``, the label of a material, on black."""
    y, x = np.mgrid[-63.5:64, -63.5:64]
    return (np.hypot(x, y) < 56)[..., None] * decode(np.array([255, 128, 0]) / 255)


def write_png(picture: Array, path: Path) -> None:
    """Write a picture with 8 bits per channel."""
    codes = np.rint(255 * encode(picture)).astype(np.uint8)
    Image.fromarray(codes).save(path, optimize=True)


def write_exr(picture: Array, path: Path) -> None:
    """Write a picture as half floats, with a date that stays."""
    height, width, _ = picture.shape
    spec = OpenImageIO.ImageSpec(width, height, 3, OpenImageIO.HALF)
    spec["compression"] = "zip"
    spec["DateTime"] = "2026:01:01 00:00:00"
    output = OpenImageIO.ImageOutput.create(str(path))
    output.open(str(path), spec)
    output.write_image(picture.astype(np.float32))
    output.close()


if __name__ == "__main__":
    main()
