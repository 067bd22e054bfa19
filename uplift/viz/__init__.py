"""Figures, contact sheets, HTML pages and formatting of numbers, shared by the packages above the core."""

from __future__ import annotations

from uplift.viz.format import (
    capitalise,
    format_build_time,
    format_error,
    format_power_of_ten,
    format_rgb,
    format_scientific,
    format_size,
    format_time,
    pluralise,
)

__all__ = [
    "capitalise",
    "format_build_time",
    "format_error",
    "format_power_of_ten",
    "format_rgb",
    "format_scientific",
    "format_size",
    "format_time",
    "pluralise",
]
