"""Base class of the objects that `uplift.io.texture.convert` applies to an image."""

from __future__ import annotations

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace
from uplift.io.texture.alpha import ColourChannels
from uplift.io.texture.colours import Counts, Floats, make_decoder
from uplift.io.texture.source import Image, Part, Values

ReadColours = Callable[[Values], tuple[Floats, Counts]]
"""From the numbers of an image (…, 3) to linear RGB (…, 3), and counts of unusual pixels."""


@dataclass(frozen=True, eq=False)
class Converter(ABC):
    """Conversion of colours to the channels of an OpenEXR file.

    Parameters
    ----------
    sensor : Sensor
        The sensor whose linear RGB are converted.
    depth : {"half", "float"}
        Type of the channels.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.
    channels : tuple of str
        Names (N,) of the channels after R, G and B.
    header : mapping
        Attributes of every file.
    space : ImageSpace, optional
        RGB space of images, by default the one that each file states.
    """

    sensor: Sensor
    depth: str
    encoding: str
    out_of_gamut: str
    channels: tuple[str, ...]
    header: Mapping[str, Any]
    space: ImageSpace | None = field(default=None, kw_only=True)

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        """Multiply converted channels by alpha.

        Parameters
        ----------
        values : tuple of ndarray
            What `convert` returns; the arrays are not changed.
        opacity : ndarray of shape (..., 1)
            Alpha in [0, 1].

        Returns
        -------
        tuple of ndarray
            Arrays of the same shapes.
        """
        return tuple(each * opacity for each in values)

    def colour_channels(self, found: ColourChannels) -> ColourChannels:
        """Choose how the colour channels of a part are read.

        Parameters
        ----------
        found : ColourChannels
            The channels that the part has.

        Returns
        -------
        ColourChannels
            The same, by default.
        """
        return found

    def decoder(self, part: Part) -> ReadColours:
        """Make the conversion of a part's colours to linear RGB.

        Parameters
        ----------
        part : Part
            Part of an image.

        Returns
        -------
        callable
            From the numbers of the part to linear RGB, by default in [0, 1].

        Raises
        ------
        OptionError
            As `make_decoder`.
        """
        return make_decoder(self.sensor, part, self.encoding, self.out_of_gamut, self.space)

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[Converter]:
        """Prepare for an image.

        Parameters
        ----------
        image : Image
            The image.

        Yields
        ------
        Converter
            The converter for this image: the same, by default.
        """
        yield self

    def at_rows(self, part: Part, first: int, count: int) -> Converter:
        """Prepare for rows of an image, which follow one another.

        Parameters
        ----------
        part : Part
            Part of the image.
        first, count : int
            Number of the first row, in the window of the part, and number of rows.

        Returns
        -------
        Converter
            The converter for these rows: the same, by default.
        """
        return self

    @abstractmethod
    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Convert a block of colours.

        Parameters
        ----------
        rgb : ndarray of shape (..., 3)
            Linear RGB of `decoder`, float32.

        Returns
        -------
        tuple of ndarray
            R, G, B and the other channels: arrays that make (..., 3 + N) side by side.
        Counts
            Pixels that the conversion could not represent.
        """
