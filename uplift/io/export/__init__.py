"""Cubes and emission tables in the formats of other programs, a module for each kind of format."""

from uplift.io.export.arrays import write_csv, write_npz
from uplift.io.export.coeff import write_coeff
from uplift.io.export.film import write_film
from uplift.io.export.lights import write_light_program
from uplift.io.export.lut import write_fourier, write_lut
from uplift.io.export.program import LANGUAGES, write_program
from uplift.io.export.table import rounding_error

__all__ = [
    "LANGUAGES",
    "rounding_error",
    "write_coeff",
    "write_csv",
    "write_film",
    "write_fourier",
    "write_light_program",
    "write_lut",
    "write_npz",
    "write_program",
]
