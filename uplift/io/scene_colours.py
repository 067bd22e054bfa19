"""The colours of images as a scene: `uplift.build` fits only the lattice points that answer them."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import find_space
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import OptionError
from uplift.common.files import file_digest
from uplift.common.progress import Progress, ProgressCallback
from uplift.io.texture.colours import check_encoding, coloured_parts, make_decoder, space_warnings
from uplift.io.texture.image import open_image
from uplift.lattice import CORNERS, EntryBoxes, Lattice
from uplift.lattice.entry_boxes import MARGIN

BLOCK_PIXELS = 1 << 16
"""Pixels decoded at a time."""


@dataclass(frozen=True)
class Images:
    """A scene of at least one image; a `SceneLike` of `uplift.build`. Memory holds the cells of the colours only.

    ``encoding``, ``out_of_gamut`` and ``space`` are those of `uplift.io.texture.prepare`. Raises `OptionError`.
    """

    paths: tuple[Path, ...]
    encoding: str = "auto"
    out_of_gamut: str = "clip"
    space: str | None = None

    def __post_init__(self) -> None:
        check_encoding(self.encoding)
        check_method(self.out_of_gamut)
        if not self.paths:
            raise OptionError(
                "a scene must have at least one image, got none",
                hint="name an image, or build without a scene",
            )

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Return the mask (dim³,) of the lattice points that answer the colours of the images; see `SceneLike`.

        Raises `TextureError`, and `ColourError` with ``out_of_gamut="error"``. Warns of images in another RGB space.
        """
        cells = np.zeros(boxes.lattice.size, dtype=bool)
        for done, path in enumerate(self.paths):
            progress(Progress("images", done, len(self.paths)))
            for rgb in self.colours(path, sensor):
                cells[cells_touched(boxes.lattice, rgb)] = True
        return boxes.required_points(cells)

    def describe(self) -> list[dict[str, Any]]:
        """Return name and digest of each image, and how it was decoded, as JSON values."""
        decoding = {"encoding": self.encoding, "out_of_gamut": self.out_of_gamut}
        decoding |= {} if self.space is None else {"space": self.space}
        return [{"name": path.name, "digest": file_digest(path), **decoding} for path in self.paths]

    def colours(self, path: Path, sensor: Sensor) -> Iterator[Array]:
        """Yield the colours of an image, linear RGB (n, 3) in [0, 1] of a sensor, block by block."""
        space = None if self.space is None else find_space(self.space)
        with open_image(path) as image:
            for warning in space_warnings(image, sensor, space):
                warnings.warn(warning, stacklevel=5)
            for part, channels in coloured_parts(image):
                decode = make_decoder(sensor, part, self.encoding, self.out_of_gamut, space)
                for _, band in image.bands(part):
                    pixels = band.reshape(-1, band.shape[-1])
                    for first in range(0, len(pixels), BLOCK_PIXELS):
                        yield decode(channels.straight(pixels[first : first + BLOCK_PIXELS]))[0].astype(float)


def cells_touched(lattice: Lattice, rgb: Array) -> Indices:
    """Return the numbers (m,) of the cells around linear RGB (n, 3), and of those within rounding error of them."""
    (low, _), (high, _) = lattice.cell(rgb - MARGIN), lattice.cell(rgb + MARGIN)
    on_face = (low != high).any(axis=1)
    adjacent = np.where(CORNERS[:, None, :] == 1, high[on_face], low[on_face]).reshape(-1, 3)
    return np.concatenate([lattice.index(low), lattice.index(adjacent)])
