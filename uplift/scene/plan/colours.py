"""Colours of textures: random samples of pixels, and one colour of every occupied bin of RGB."""

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
from uplift.io.texture.channels import coloured_parts
from uplift.io.texture.image import open_image
from uplift.lattice import Lattice
from uplift.lattice.entry_boxes import EntryBoxes

BINS = 64
"""Bins along each channel of encoded RGB: four 8-bit codes wide."""


@dataclass(frozen=True, eq=False)
class PixelSample:
    """Distinct linear RGB (n, 3), and the share (n,) of the sampled pixels that have each; shares sum to 1."""

    rgb: Array
    share: Array


@dataclass(frozen=True, eq=False)
class SampledColours:
    """Disjoint samples of the textures' pixels, to choose candidates by and to verify the result.

    Textures with fewer pixels than both need together have all pixels in both. ``colour_bins`` (n, 3) has a colour of
    every bin that has any pixel, in linear RGB.
    """

    predicting: PixelSample
    confirming: PixelSample
    colour_bins: Array


def sample_colours(
    textures: tuple[Path, ...],
    sensor: Sensor,
    encoding: str,
    sizes: tuple[int, int],
    progress: ProgressCallback = ignore_progress,
) -> SampledColours:
    """Sample about ``sizes`` pixels to predict and to confirm, all pixels with equal probability.

    The sample is the same every time. Raises `TextureError`, and `PlanFileError` for textures without pixels.
    """
    total, scene = sum(map(_pixel_count, textures)), Images(textures, encoding)
    if not total:
        raise PlanFileError("textures must have pixels, got none", hint="name an image with pixels")
    first = sizes[0] / total
    last = first + sizes[1] / total
    rng, bins = np.random.default_rng(0), np.full((BINS**3, 3), np.nan)
    samples: tuple[list[Array], list[Array]] = [], []
    for done, path in enumerate(textures):
        progress(Progress("textures", done, len(textures)))
        for rgb in scene.colours(path, sensor):
            bins[_bin_index(sensor, rgb)] = rgb
            lot = rng.random(len(rgb))
            samples[0].append(rgb[(lot < first) | (last > 1)])
            samples[1].append(rgb[(lot >= first) & (lot < last) | (last > 1)])
    occupied = bins[~np.isnan(bins[:, 0])]
    predicting, confirming = (_distinct(np.concatenate(each), occupied) for each in samples)
    return SampledColours(predicting, confirming, occupied)


def _pixel_count(path: Path) -> int:
    """Pixels of the parts of an image that have colour channels."""
    with open_image(path) as image:
        return sum(part.window.width * part.window.height for part, _ in coloured_parts(image))


def _bin_index(sensor: Sensor, rgb: Array) -> Any:
    codes = np.interp(rgb, sensor.decoding, np.linspace(0, BINS, 256))
    red, green, blue = np.minimum(codes, BINS - 1).astype(int).T
    return (red * BINS + green) * BINS + blue


def _distinct(sample: Array, occupied: Array) -> PixelSample:
    """Each sampled colour once; the colours of the bins for an empty sample."""
    rgb, counts = np.unique(sample if len(sample) else occupied, axis=0, return_counts=True)
    return PixelSample(rgb, counts / counts.sum())


@dataclass(frozen=True, eq=False)
class ColourSet:
    """Scene of linear RGB (n, 3) for `uplift.build`: the cube gets the lattice points that the colours need."""

    rgb: Array

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Lattice points (dim³,) that the colours need."""
        return boxes.required_points(occupied_cells(boxes.lattice, self.rgb))

    def describe(self) -> list[dict[str, Any]]:
        """An empty list: colours have no source files."""
        return []


def occupied_cells(lattice: Lattice, rgb: Array) -> Mask:
    """Mask (dim³,) of the cells that contain linear RGB (n, 3)."""
    occupied = np.zeros(lattice.size, dtype=bool)
    occupied[cells_touched(lattice, rgb)] = True
    return occupied
