"""Cubes and emission tables in the formats of other programs, a module for each kind of
format.
"""

from uplift.extras.export.arrays import write_npz
from uplift.extras.export.coeff import write_coeff
from uplift.extras.export.film import write_film
from uplift.extras.export.light_program import write_light_program
from uplift.extras.export.lut import write_lut
from uplift.extras.export.material_error import MaterialError, material_error
from uplift.extras.export.outputs import output_files
from uplift.extras.export.program import LANGUAGES, check_form, write_program
from uplift.extras.export.program_table import moved_cells
from uplift.extras.export.rounding import rounding_error
from uplift.extras.export.table_error import TableError

__all__ = [
    "LANGUAGES",
    "MaterialError",
    "TableError",
    "check_form",
    "material_error",
    "moved_cells",
    "output_files",
    "rounding_error",
    "write_coeff",
    "write_film",
    "write_light_program",
    "write_lut",
    "write_npz",
    "write_program",
]
