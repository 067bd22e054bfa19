"""The colours of textures: some of their pixels, drawn at random, and one colour of every kind."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask
from uplift.common.errors import PlanFileError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.scene_colours import Images, cells_touched
from uplift.io.texture.part_layout import colour_channels_by_part
from uplift.io.texture.source import open_image
from uplift.lattice import Lattice
from uplift.lattice.entry_boxes import EntryBoxes

STEPS = 64
"""Kinds of colours along each channel, of encoded RGB: four 8-bit codes wide."""

"""Told how many of how many are done."""


@dataclass(frozen=True, eq=False)
class Pixels:
    """Different linear RGB (n, 3) and the share (n,) of the pixels that each stands for; shares sum to 1."""

    rgb: Array
    share: Array


@dataclass(frozen=True, eq=False)
class SampledColours:
    """Two draws of pixels, to choose by and to confirm by, with none in common; ``kinds`` (n, 3) linear RGB.

    Each kind of colour that any pixel has, be it rare, has one in ``kinds``. Textures with fewer pixels than are to be
    drawn have all of them in both draws.
    """

    predicting: Pixels
    confirming: Pixels
    colour_bins: Array


def sample_colours(
    textures: tuple[Path, ...],
    sensor: Sensor,
    encoding: str,
    wanted: tuple[int, int],
    progress: ProgressCallback = ignore_progress,
) -> SampledColours:
    """About so many pixels as are ``wanted`` to predict and to confirm, of all pixels alike; the same each time.

    Raises `TextureError`, and `PlanFileError` for images without a pixel.
    """
    total, scene = sum(map(_pixels, textures)), Images(textures, encoding)
    if not total:
        raise PlanFileError("the textures have no pixels", hint="name one that has")
    first = wanted[0] / total
    last = first + wanted[1] / total
    rng, kinds = np.random.default_rng(0), np.full((STEPS**3, 3), np.nan)
    drawn: tuple[list[Array], list[Array]] = [], []
    for done, path in enumerate(textures):
        progress(Progress("textures", done, len(textures)))
        for rgb in scene.colours(path, sensor):
            kinds[_kind(sensor, rgb)] = rgb
            lot = rng.random(len(rgb))
            drawn[0].append(rgb[(lot < first) | (last > 1)])
            drawn[1].append(rgb[(lot >= first) & (lot < last) | (last > 1)])
    there = kinds[~np.isnan(kinds[:, 0])]
    predicting, confirming = (_distinct(np.concatenate(each), there) for each in drawn)
    return SampledColours(predicting, confirming, there)


def _pixels(path: Path) -> int:
    """Pixels of an image that have a colour."""
    with open_image(path) as image:
        return sum(
            part.window.width * part.window.height
            for part, places in colour_channels_by_part(image)
            if places
        )


def _kind(sensor: Sensor, rgb: Array) -> Any:
    """Numbers (n,) of the kinds that linear RGB (n, 3) are of."""
    codes = np.interp(rgb, sensor.decoding, np.linspace(0, STEPS, 256))
    red, green, blue = np.minimum(codes, STEPS - 1).astype(int).T
    return (red * STEPS + green) * STEPS + blue


def _distinct(drawn: Array, kinds: Array) -> Pixels:
    """Each colour once; should the draw be empty, the kinds."""
    rgb, times = np.unique(drawn if len(drawn) else kinds, axis=0, return_counts=True)
    return Pixels(rgb, times / times.sum())


@dataclass(frozen=True, eq=False)
class ColourSet:
    """The scene of linear RGB (n, 3), for `uplift.build`: points for these colours alone."""

    rgb: Array

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        return boxes.required_points(occupied_cells(boxes.lattice, self.rgb))

    def describe(self) -> list[dict[str, Any]]:
        return []


def occupied_cells(lattice: Lattice, rgb: Array) -> Mask:
    """Which cells (dim³,) linear RGB (n, 3) lie in."""
    found = np.zeros(lattice.size, dtype=bool)
    found[cells_touched(lattice, rgb)] = True
    return found
