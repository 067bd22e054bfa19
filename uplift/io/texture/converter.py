"""Base class of the objects that `uplift.io.texture.convert` applies to an image."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace
from uplift.io.texture.colours import Counts, Floats


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

    @abstractmethod
    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Convert a block of colours.

        Parameters
        ----------
        rgb : ndarray of shape (..., 3)
            Linear RGB in [0, 1], float32.

        Returns
        -------
        tuple of ndarray
            R, G, B and the other channels: arrays that make (..., 3 + N) side by side.
        Counts
            Pixels that the conversion could not represent.
        """
