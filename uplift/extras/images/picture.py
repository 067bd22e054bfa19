"""An image as one array, reduced to a size that a screen shows."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Floats, Mask, StrPath
from uplift.common.errors import UpliftWarning
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import open_image
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
        width = part.window.width
        height = part.window.height
        step = -(-max(width, height) // max_side)
        columns = np.arange(0, width, step)
        rows = np.arange(height) // step
        # of colours times alpha, alpha, and visible pixels
        sums = np.zeros((rows[-1] + 1, len(columns), 5))
        counts = Counts()
        for first, band in image.bands(part):
            rgb, decoded = decode(channels.straight(band))
            counts += decoded
            visible = channels.visible(band)[..., None]
            opacity = channels.opacity(band)
            weight = np.ones_like(rgb[..., :1]) if opacity is None else opacity
            values = np.concatenate([rgb * weight, weight, visible], axis=-1)
            in_columns = np.add.reduceat(values, columns, axis=1, dtype=float)
            np.add.at(sums, rows[first : first + len(band)], in_columns)
        warnings = (*counts.warnings(path), *reader.warnings(image))
    widths = np.diff(np.append(columns, width))
    pixels = np.bincount(rows)[:, None, None] * widths[:, None]
    means: Floats = (sums / pixels).astype(np.float32)
    rgb = means[..., :3]
    weights = means[..., 3:4]
    visible = means[..., 4] > 0
    if channels.alpha is None:
        return Picture(rgb, None, step, warnings, visible)
    straight = np.minimum(rgb / np.where(weights > 0, weights, 1), 1)
    return Picture(straight.astype(np.float32), weights, step, warnings, visible)
