"""Colorimetry: sensors, illuminants, sRGB, ΔE, gamut mapping, and the object-colour solid."""

from __future__ import annotations

from uplift.colorimetry.delta_e import delta_e_1976, delta_e_2000, delta_e_rgb, delta_e_spectra, lab
from uplift.colorimetry.gamut import GamutMapped, Primaries, map_to_gamut
from uplift.colorimetry.sensor import Light, Sensor
from uplift.colorimetry.solid import Solid

__all__ = [
    "GamutMapped",
    "Light",
    "Primaries",
    "Sensor",
    "Solid",
    "delta_e_1976",
    "delta_e_2000",
    "delta_e_rgb",
    "delta_e_spectra",
    "lab",
    "map_to_gamut",
]
