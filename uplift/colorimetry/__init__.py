"""Colorimetry: sensors, illuminants, ΔE and gamut mapping."""

from uplift.colorimetry.delta_e import delta_e_1976, delta_e_2000, delta_e_rgb, delta_e_spectra, lab
from uplift.colorimetry.gamut import GamutMapped, Primaries, map_to_gamut
from uplift.colorimetry.sensor import Light, Sensor

__all__ = [
    "GamutMapped",
    "Light",
    "Primaries",
    "Sensor",
    "delta_e_1976",
    "delta_e_2000",
    "delta_e_rgb",
    "delta_e_spectra",
    "lab",
    "map_to_gamut",
]
