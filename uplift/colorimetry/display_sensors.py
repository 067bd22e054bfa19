"""The lights that a report looks under, and how a screen shows what is seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uplift.colorimetry.gamut import SRGB, Gamut
from uplift.colorimetry.observer import sensor
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array


def display_sensors(names: Sequence[str], observer: str) -> tuple[Sensor, ...]:
    """An sRGB sensor under each light, each light once: its white is taken to the screen's by Bradford.

    Raises `UnknownNameError`.
    """
    found = (sensor("sRGB", name, observer) for name in names)
    return tuple({viewing.illuminant: viewing for viewing in found}.values())


def hex_codes(rgb: Array, gamut: Gamut = SRGB) -> list[str]:
    """``#rrggbb`` of linear RGB (n, 3); what the screen cannot show has less chroma there."""
    return ["#" + bytes(code).hex() for code in to_display_codes(rgb, gamut).astype(np.uint8)]
