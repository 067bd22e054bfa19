"""Colorimetry: sensors and lights, RGB spaces and gamuts, the solid of object colours,
ΔE and expected errors.
"""

from uplift.colorimetry.delta_e import (
    delta_e_1976,
    delta_e_2000,
    delta_e_2000_form,
    delta_e_2000_terms,
    delta_e_2000_weights,
    delta_e_rgb,
    delta_e_spectra,
    lab,
    lab_jacobian,
    lab_to_xyz,
    rgb_to_lab,
)
from uplift.colorimetry.object_colours import Solid, solid, solid_volume, toward_grey
from uplift.colorimetry.sensor import (
    ROUNDING,
    Light,
    Sensor,
    as_rgb,
    format_rgb,
    in_unit_cube,
    raise_out_of_gamut,
)

__all__ = [
    "ROUNDING",
    "Light",
    "Sensor",
    "Solid",
    "as_rgb",
    "delta_e_1976",
    "delta_e_2000",
    "delta_e_2000_form",
    "delta_e_2000_terms",
    "delta_e_2000_weights",
    "delta_e_rgb",
    "delta_e_spectra",
    "format_rgb",
    "in_unit_cube",
    "lab",
    "lab_jacobian",
    "lab_to_xyz",
    "raise_out_of_gamut",
    "rgb_to_lab",
    "solid",
    "solid_volume",
    "toward_grey",
]
