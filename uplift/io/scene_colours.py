"""A scene: the colours that are to be answered, and the lattice points that they need. No more need be built."""

from __future__ import annotations

import hashlib
import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from uplift.colorimetry.gamut import check_method
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask
from uplift.common.errors import OptionError
from uplift.common.progress import Progress, ProgressCallback
from uplift.cube import CubeData
from uplift.io.texture.colours import check_encoding, make_decoder
from uplift.io.texture.part_layout import colour_channels_by_part
from uplift.io.texture.source import open_image
from uplift.lattice import CORNERS, Lattice
from uplift.lattice.entry_boxes import MARGIN, EntryBoxes

BLOCK = 1 << 16
"""Pixels looked at at a time."""


class Scene(Protocol):
    """What `uplift.build` asks of a scene."""

    def points(self, pins: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Which points (dim³,) of the lattice, with entries as pins, its colours need."""
        ...

    def describe(self) -> list[dict[str, Any]]:
        """Where its colours come from, in JSON values."""
        ...


@dataclass(frozen=True)
class Images:
    """The colours of images, decoded as `uplift.io.texture.prepare` does; only the cells around them are kept."""

    paths: tuple[Path, ...]
    encoding: str = "auto"
    out_of_gamut: str = "clip"

    def points(self, pins: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Raises `OptionError`, `TextureError`, and `ColourError` for colours outside [0, 1] that are an error.

        An `UpliftWarning` names images that say they are of another space.
        """
        check_encoding(self.encoding)
        check_method(self.out_of_gamut)
        cells = np.zeros(pins.lattice.size, dtype=bool)
        for done, path in enumerate(self.paths):
            progress(Progress("images", done, len(self.paths)))
            for rgb in self.colours(path, sensor):
                cells[cells_touched(pins.lattice, rgb)] = True
        if not cells.any():
            raise OptionError(
                "a scene without images has no colours", hint="name one, or build without a scene"
            )
        return pins.needs(cells)

    def describe(self) -> list[dict[str, Any]]:
        read = {"encoding": self.encoding, "out_of_gamut": self.out_of_gamut}
        return [{"name": path.name, "digest": file_digest(path), **read} for path in self.paths]

    def colours(self, path: Path, sensor: Sensor) -> Iterator[Array]:
        """Linear RGB (n, 3) in [0, 1] of an image, block by block."""
        with open_image(path) as image:
            for warning in image.warnings(sensor):
                warnings.warn(warning, stacklevel=5)
            for part, places in colour_channels_by_part(image):
                if places is None:
                    continue
                decode = make_decoder(sensor, part, self.encoding, self.out_of_gamut)
                for _, band in image.bands(part):
                    pixels = band.reshape(-1, band.shape[-1])
                    for first in range(0, len(pixels), BLOCK):
                        yield decode(pixels[first : first + BLOCK, places])[0].astype(float)


@dataclass(frozen=True, eq=False)
class StoredScene:
    """The very points of a cube that was built for a scene: no image is needed to make it again."""

    data: CubeData

    def points(self, pins: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Raises `OptionError`."""
        if self.data.lattice.dim != pins.lattice.dim:
            raise OptionError(f"the scene's points are those of dim {self.data.lattice.dim}")
        return self.data.points.present

    def describe(self) -> list[dict[str, Any]]:
        return list(self.data.provenance["scene"])


SceneLike = Scene | str | os.PathLike[str] | Sequence[str | os.PathLike[str]]


def as_scene(given: SceneLike) -> Scene:
    """Images by their paths, or a scene as it is."""
    if isinstance(given, str | os.PathLike):
        return Images((Path(given),))
    return Images(tuple(map(Path, given))) if isinstance(given, Sequence) else given


def cells_touched(lattice: Lattice, rgb: Array) -> Array:
    """Numbers of the cells that linear RGB (n, 3) lie in, or on the face of: rounding decides which."""
    low, high = lattice.lowest(rgb - MARGIN), lattice.lowest(rgb + MARGIN)
    between = (low != high).any(axis=1)
    beside = np.where(CORNERS[:, None, :] == 1, high[between], low[between]).reshape(-1, 3)
    return np.concatenate([lattice.index(low), lattice.index(beside)])


def file_digest(path: Path) -> str:
    """sha256 (hex) of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
