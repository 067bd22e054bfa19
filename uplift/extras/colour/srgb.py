"""Colours as codes: the sRGB transfer curve (IEC 61966-2-1), linear RGB for display,
and colours as files write them.

Image viewers show a PNG as sRGB for every space of the cube, so this is separate from
the encoding of a cube.
"""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut import SRGB, Gamut, conversion, map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.common.text import format_value

DISPLAY_MAPPING = "desaturate"
"""Gamut mapping of swatches: it keeps luminance and dominant wavelength."""
HEX = re.compile("#[0-9a-fA-F]{6}")
MAX_NUMBER = 1e6
"""Larger numbers are typing errors."""


def decode(codes: Array) -> Array:
    """Convert encoded sRGB to linear values, both in [0, 1]."""
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def encode(linear: ArrayLike) -> Array:
    """Convert linear values to encoded sRGB in [0, 1], clipping values outside."""
    inside = np.clip(np.asarray(linear, dtype=float), 0, 1)
    return np.where(
        inside <= 0.0031308, inside * 12.92, 1.055 * inside ** (1 / 2.4) - 0.055
    )


def to_display_codes(rgb: ArrayLike, gamut: Gamut) -> Array:
    """Convert linear RGB of a gamut to 8-bit sRGB codes, white to white. Shapes:
    ``rgb`` (…, 3) → (…, 3).
    """
    linear = np.asarray(rgb, dtype=float) @ conversion(gamut, SRGB).T
    return np.rint(255 * encode(map_to_gamut(linear, SRGB, DISPLAY_MAPPING).rgb))


def hex_codes(rgb: Array, gamut: Gamut = SRGB) -> list[str]:
    """Convert linear RGB (n, 3) of a gamut to ``#rrggbb`` codes, by `to_display_codes`.

    >>> import numpy as np
    >>> hex_codes(np.array([[1.0, 0.5, 0.0]]))
    ['#ffbc00']
    """
    return [
        "#" + bytes(code).hex()
        for code in to_display_codes(rgb, gamut).astype(np.uint8)
    ]


@dataclass(frozen=True)
class WrittenColour:
    """A colour as written: 8-bit ``codes``, or ``linear`` RGB."""

    codes: tuple[int, ...] = ()
    linear: tuple[float, ...] = ()

    def rgb(self, sensor: Sensor) -> Array:
        """Convert to the linear RGB of a sensor. Shape (3,)."""
        return sensor.decode(self.codes) if self.codes else np.array(self.linear)


def parse_colour(value: Any) -> WrittenColour:
    """Parse ``"#rrggbb"`` or three linear numbers.

    >>> parse_colour("#cc3319").codes
    (204, 51, 25)
    """
    if isinstance(value, str) and HEX.fullmatch(value):
        return WrittenColour(codes=tuple(bytes.fromhex(value[1:])))
    if isinstance(value, list | tuple | np.ndarray) and len(value) == 3:
        numbers = value.tolist() if isinstance(value, np.ndarray) else value
        if all(map(is_number, numbers)):
            return WrittenColour(linear=tuple(map(float, numbers)))
    raise ColourError(
        f"must be '#rrggbb' or three linear numbers, got {format_value(value)}",
        hint="write '#cc3319' or [0.6, 0.03, 0.01]",
    )


def is_number(value: object) -> bool:
    """Test whether a value is a finite number, and not absurdly large."""
    return (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and abs(value) <= MAX_NUMBER
    )
