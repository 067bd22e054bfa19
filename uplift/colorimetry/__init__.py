"""Colorimetry: sensors, illuminants, ΔE and gamut mapping."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from uplift.colorimetry.delta_e import delta_e_1976, delta_e_2000, delta_e_rgb, delta_e_spectra, lab
from uplift.colorimetry.sensor import Light, Sensor

if TYPE_CHECKING:
    from uplift.colorimetry.gamut import GamutMapped, Primaries, map_to_gamut

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


def __getattr__(name: str) -> Any:
    if name not in ("GamutMapped", "Primaries", "map_to_gamut"):
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module("uplift.colorimetry.gamut"), name)  # plain queries start without it
