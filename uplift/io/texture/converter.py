"""Interface of the objects that `uplift.io.texture.convert` applies to an image."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from uplift.colorimetry.sensor import Sensor
from uplift.io.texture.colours import Counts, Floats


class Converter(Protocol):
    """Conversion of colours to the channels of an OpenEXR file, and the settings to read and write them by."""

    @property
    def sensor(self) -> Sensor:
        """The sensor whose RGB space images are in."""
        ...

    @property
    def encoding(self) -> str:
        """Interpretation of the numbers in images, one of `uplift.io.texture.ENCODINGS`."""
        ...

    @property
    def out_of_gamut(self) -> str:
        """Gamut mapping for pixels outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`."""
        ...

    @property
    def depth(self) -> str:
        """Type of the channels written: half or float."""
        ...

    @property
    def channels(self) -> tuple[str, ...]:
        """Names (N,) of the channels that `convert` appends to R, G and B."""
        ...

    @property
    def header(self) -> Mapping[str, Any]:
        """Attributes of every file."""
        ...

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
        ...
