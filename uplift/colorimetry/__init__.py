"""Colorimetry: sensors and lights, RGB spaces and gamuts, the solid of object colours,
ΔE and expected errors.
"""

from uplift.colorimetry.delta_e import (
    delta_e_1976,
    delta_e_2000,
    delta_e_rgb,
    delta_e_spectra,
    lab,
)
from uplift.colorimetry.sensor import Light, Sensor

__all__ = [
    "Light",
    "Sensor",
    "delta_e_1976",
    "delta_e_2000",
    "delta_e_rgb",
    "delta_e_spectra",
    "lab",
]
