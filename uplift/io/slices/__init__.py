"""Cubes as multi-part OpenEXR files, one part per slice of constant blue."""

from __future__ import annotations

from uplift.io.slices.slices import check_slices, write_slices

__all__ = ["check_slices", "write_slices"]
