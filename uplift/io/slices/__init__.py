"""Cubes as multi-part OpenEXR files, one part per slice of constant blue, and emission tables as one image."""

from __future__ import annotations

from uplift.io.slices.lights import light_attributes, write_light_slices
from uplift.io.slices.slices import check_slices, write_slices

__all__ = [
    "check_slices",
    "light_attributes",
    "write_light_slices",
    "write_slices",
]
