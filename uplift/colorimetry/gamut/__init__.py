"""Gamut mapping: linear RGB outside [0, 1] moved inside (docs/display.md)."""

from __future__ import annotations

from uplift.colorimetry.gamut.apply import METHODS, GamutMapped, as_rgb, check_method, map_to_gamut, raise_out_of_gamut
from uplift.colorimetry.gamut.boundary import SRGB, Gamut, Primaries, conversion

__all__ = [
    "METHODS",
    "SRGB",
    "Gamut",
    "GamutMapped",
    "Primaries",
    "as_rgb",
    "check_method",
    "conversion",
    "map_to_gamut",
    "raise_out_of_gamut",
]
