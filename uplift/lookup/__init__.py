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
    blockwise,
    decode_codes,
)
from uplift.lookup.cube import Cube, expected_errors, find_file, load
from uplift.lookup.errors_under_lights import (
    LightErrors,
    evidence,
    light_errors,
    outside_errors,
)
from uplift.lookup.interpolate import (
    MODES,
    around,
    extended_multipliers,
    refined_multipliers,
)
from uplift.lookup.node_table import prepare_products
from uplift.lookup.outside import MAPPING, reflectance_anywhere
from uplift.lookup.refine import refine_to_rgb

__all__ = [
    "BLOCK",
    "MAPPING",
    "MODES",
    "Cube",
    "Function",
    "LightErrors",
    "around",
    "as_colours",
    "as_float_type",
    "as_thread_count",
    "as_wavelengths",
    "blockwise",
    "decode_codes",
    "evidence",
    "expected_errors",
    "extended_multipliers",
    "find_file",
    "light_errors",
    "load",
    "outside_errors",
    "prepare_products",
    "refine_to_rgb",
    "refined_multipliers",
    "reflectance_anywhere",
]
