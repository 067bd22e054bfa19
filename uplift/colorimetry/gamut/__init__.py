"""Displaying the undisplayable: linear RGB outside [0, 1], brought inside (docs/display.md). numpy alone.

from uplift.colorimetry.gamut import SRGB, contained

contained([[1.4, 0.2, -0.1]], SRGB, "desaturate").rgb
"""

from __future__ import annotations

from uplift.colorimetry.gamut.apply import CHOICES, Contained, check_way, contained, refuse, triples
from uplift.colorimetry.gamut.boundary import SRGB, Gamut, Primaries, conversion

__all__ = [
    "CHOICES",
    "SRGB",
    "Contained",
    "Gamut",
    "Primaries",
    "check_way",
    "contained",
    "conversion",
    "refuse",
    "triples",
]
