"""Palettes: lights and materials designed for the colours that they must produce
together (docs/palette.md).

Sections and equations are those of S. Bergner, T. Möller, M. S. Drew, *A Spectral
Engine for Visualization*, 2004.
"""

from uplift.extras.palette.colours import illuminant
from uplift.extras.palette.design import design, matrix, write_designed
from uplift.extras.palette.factor import standard_model
from uplift.extras.palette.spec import read_palette
from uplift.extras.palette.unmet import unmet_goals

__all__ = [
    "design",
    "illuminant",
    "matrix",
    "read_palette",
    "standard_model",
    "unmet_goals",
    "write_designed",
]
