"""Queries of a cube with numpy alone: neither the fit, JAX nor colour-science is
imported.
"""

from uplift.lookup.blocks import (
    BLOCK,
    Function,
    as_colours,
    as_float_type,
    as_thread_count,
    as_wavelengths,
    as_whole_number,
    blockwise,
    decode_codes,
)
from uplift.lookup.cube import Cube, expected_errors, find_file, load
from uplift.lookup.interpolate import (
    MODES,
    around,
    extended_multipliers,
    refined_multipliers,
)
from uplift.lookup.refine import refine_to_rgb

__all__ = [
    "BLOCK",
    "MODES",
    "Cube",
    "Function",
    "around",
    "as_colours",
    "as_float_type",
    "as_thread_count",
    "as_wavelengths",
    "as_whole_number",
    "blockwise",
    "decode_codes",
    "expected_errors",
    "extended_multipliers",
    "find_file",
    "load",
    "refine_to_rgb",
    "refined_multipliers",
]
