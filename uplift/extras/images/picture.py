"""An image as one array, reduced to a size that a screen shows."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Floats, Mask, StrPath, Values
from uplift.common.errors import UpliftWarning
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Part, open_image
from uplift.extras.images.reader import SurfaceReader


@dataclass(frozen=True, eq=False)
class Picture:
    """Linear RGB (height, width, 3) in [0, 1], divided by alpha, and the alpha (height,
    width, 1) of divided colours.

    ``reduction`` pixels of the image make one of the picture, along each side, which is
    ``visible`` (height, width) unless all are transparent.
    """

    rgb: Floats
    opacity: Floats | None
    reduction: int
    warnings: tuple[UpliftWarning, ...]
    visible: Mask


def read_picture(
    path: StrPath, sensor: Sensor, *, max_side: int, **reading: Any
) -> Picture:
    """Read the first part of an image that has colours, at most ``max_side`` wide and
    high, by a `SurfaceReader` of these settings.

    Pixels of a larger image are averaged in linear RGB, weighted by alpha where the
    file holds colours multiplied by it. Warnings are returned, not emitted. Raises
    `TextureError`, `ColourError` and `OptionError` as `uplift.extras.texture.convert`.
    """
    reader = SurfaceReader(sensor=sensor, **reading)
    with open_image(path) as image:
        part, channels = coloured_parts(image)[0]
        decode = reader.decoder(part)
        mean = _Reducer(part, max_side, 3)
        opacities = _Reducer(part, max_side, 1)
        shown = _Reducer(part, max_side, 1)
        counts = Counts()
        for first, band in image.bands(part):
            rgb, decoded = decode(channels.straight(band))
            shown.add(first, channels.visible(band)[..., None])
            opacity = channels.opacity(band)
            if opacity is not None:
                opacities.add(first, opacity)
            mean.add(first, rgb if opacity is None else rgb * opacity)
            counts += decoded
        warnings = (*counts.warnings(path), *reader.warnings(image))
    visible = shown.result()[..., 0] > 0
    if channels.alpha is None:
        return Picture(mean.result(), None, mean.step, warnings, visible)
    weights = opacities.result()
    colours = np.minimum(mean.result() / np.where(weights > 0, weights, 1), 1)
    return Picture(colours.astype(np.float32), weights, mean.step, warnings, visible)


class _Reducer:
    """Means of squares of pixels, from bands of rows."""

    def __init__(self, part: Part, max_side: int, channels: int) -> None:
        width = part.window.width
        height = part.window.height
        self.step = -(-max(width, height) // max_side)
        self._columns = np.arange(0, width, self.step)
        self._total = np.zeros((-(-height // self.step), len(self._columns), channels))
        self._rows = np.bincount(np.arange(height) // self.step)
        self._widths = np.diff(np.append(self._columns, width))

    def add(self, first: int, rgb: Values) -> None:
        """Add rows (k, width, channels) from row ``first`` on."""
        sums = np.add.reduceat(rgb, self._columns, axis=1, dtype=float)
        np.add.at(self._total, (first + np.arange(len(rgb))) // self.step, sums)

    def result(self) -> Floats:
        """Return the means (height, width, channels)."""
        return (
            self._total / (self._rows[:, None, None] * self._widths[:, None])
        ).astype(np.float32)
