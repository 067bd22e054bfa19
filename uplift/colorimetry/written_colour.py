"""Colours as they are written in files: 8-bit codes, or linear numbers."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.common.text import format_value

HEX = re.compile("#[0-9a-fA-F]{6}")
MAX_NUMBER = 1e6
"""Larger numbers are typing errors."""


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
        code="invalid-colour",
        hint="write '#cc3319' or [0.6, 0.03, 0.01]",
    )


def is_number(value: object) -> bool:
    """Test whether a value is a finite number, and not absurdly large."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= MAX_NUMBER
