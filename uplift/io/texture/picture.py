"""An image as one array, reduced to a size that a screen shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace
from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftWarning
from uplift.io.texture.colours import Counts, Floats, check_encoding, make_decoder
from uplift.io.texture.part_layout import colour_channels_by_part
from uplift.io.texture.source import Part, Values, open_image
from uplift.io.texture.source_space import space_warnings


@dataclass(frozen=True, eq=False)
class Picture:
    """The colours of an image.

    Parameters
    ----------
    rgb : ndarray of float32, shape (height, width, 3)
        Linear RGB in [0, 1], not multiplied by alpha.
    opacity : ndarray of float32, shape (height, width, 1), or None
        Alpha in [0, 1], if the file holds colours multiplied by it.
    reduction : int
        Pixels of the image per pixel of the picture, along each side.
    warnings : tuple of UpliftWarning
        Warnings about the image, not emitted.
    """

    rgb: Floats
    opacity: Floats | None
    reduction: int
    warnings: tuple[UpliftWarning, ...]


def read_picture(
    path: StrPath,
    sensor: Sensor,
    *,
    max_side: int,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: ImageSpace | None = None,
) -> Picture:
    """Read the first part of an image that has colours. Pixels of a larger image are averaged in linear RGB,
    weighted by alpha where the file holds colours multiplied by it.

    Parameters
    ----------
    path : path-like
        OpenEXR, Radiance HDR, PNG, JPEG or TIFF image.
    sensor : Sensor
        RGB space of the colours.
    max_side : int
        Largest width and height of the picture.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers; ``auto`` takes integers as encoded, floats as linear.
    out_of_gamut : str
        Gamut mapping for colours outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.

    space : ImageSpace, optional
        RGB space of the image, by default the one that the file states.

    Returns
    -------
    Picture

    Raises
    ------
    TextureError
        The image cannot be read, or has no colour channels.
    ColourError
        A colour lies outside [0, 1] and the gamut mapping is ``error``.
    OptionError
        An unknown encoding, or a gamut mapping that encoded floats do not allow.
    """
    check_encoding(encoding)
    with open_image(path) as image:
        part, channels = next(
            (part, channels) for part, channels in colour_channels_by_part(image) if channels is not None
        )
        decode = make_decoder(sensor, part, encoding, out_of_gamut, space)
        mean, opacities = _Reducer(part, max_side, 3), _Reducer(part, max_side, 1)
        counts = Counts()
        for first, band in image.bands(part):
            rgb, decoded = decode(channels.straight(band))
            opacity = channels.opacity(band)
            if opacity is not None:
                opacities.add(first - part.window.y, opacity)
            mean.add(first - part.window.y, rgb if opacity is None else rgb * opacity)
            counts += decoded
        warnings = (*counts.warnings(out_of_gamut, path), *space_warnings(image, sensor, space))
    if channels.alpha is None:
        return Picture(mean.result(), None, mean.step, warnings)
    weights = opacities.result()
    colours = np.minimum(mean.result() / np.where(weights > 0, weights, 1), 1)
    return Picture(colours.astype(np.float32), weights, mean.step, warnings)


class _Reducer:
    """Means of squares of pixels, from bands of rows."""

    def __init__(self, part: Part, max_side: int, channels: int) -> None:
        width, height = part.window.width, part.window.height
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
        return (self._total / (self._rows[:, None, None] * self._widths[:, None])).astype(np.float32)
