"""Names that the kernel uses: types, sizes of a cube, and functions that each language provides.

The kernel, in `lattice`, `moments` and `sigmoid`, is restricted Python that `translate` prints in other languages:
scalars declared by an annotation, arrays of constant size, loops over ranges, conditions and arithmetic. Arrays are
passed by reference. Tests run the same functions in Python.
"""

from __future__ import annotations

Float = float
Int = int
Bool = bool
Floats = list[float]

Colour = Floats
Place = Floats
Sides = Floats
Coefficients = Floats
Row = Floats
Block = Floats
Basis = Floats
Corners = Floats
Weights = Floats
Lane = Floats
Lanes = Floats
Offset = Floats
Spot = Floats

SIZES = {
    "Colour": "3",
    "Place": "4",
    "Sides": "6",
    "Coefficients": "COUNT",
    "Row": "STRIDE",
    "Block": "WIDTH",
    "Basis": "(COUNT * WIDTH)",
    "Corners": "(8 * WIDTH)",
    "Weights": "8",
    "Lane": "LANES",
    "Lanes": "(COUNT * LANES)",
    "Offset": "4",
    "Spot": "5",
}
"""Elements of each array type, as expressions of the constants below."""

WIDTH: Int
"""Wavelengths of one call: as many as a vector register or a ray has."""
LANES: Int
"""Colours whose moments are converted together."""
COUNT: Int
"""Coefficients of a spectrum."""
STRIDE: Int
"""Numbers of a row: the coefficients and the tag of the cell, padded to a multiple of four."""
DIM: Int
"""Lattice points along each axis."""
LATTICE: Int
"""Number of lattice points, and the row of the first entry."""
ENTRIES: Int
"""Index of the multipliers of the entries."""
ENTRY_COUNT: Int
"""Multipliers of an entry: as many as a lattice point has, or more."""
BIN_COUNT: Int
"""Even bins of [0, 1]."""
NODES: Int
"""Index of the first axis node in the table."""
BINS: Int
"""Index of the last nodes before each bin."""
LISTS: Int
"""Index of the lists of entries whose boxes touch a cell."""
BOXES: Int
"""Index of the boxes: centre, and reciprocals of the distances to the lower and upper faces."""
START: Float
END: Float
"""Wavelength range in nm; spectra are constant outside."""
LOW: Float
SCALE: Float
"""The warped wavelength at the start of the range, and the reciprocal of the length of the warped range."""
KNOTS: Int
RINGS: Int
"""Nodes around white and from white to the locus, of an emission table."""
SAMPLES: Int
STEP: Float
"""Wavelengths of a stored light, and the distance between them in nm."""
MATRIX: Int
"""Index of the matrix from RGB to u'v' from white, X + 15 Y + 3 Z, and that of white with the same luminance."""
WHITE: Int
"""Index of u'v' of white, and of the angle of the first knot."""
ANGLES: Int
INVERSES: Int
"""Index of the angles of the knots, and of the matrices from offsets to shares of two spokes."""
RING_SHARES: Int
"""Index of the shares of the way to the locus at which the rings lie."""
LAMPS: Int
LAMP_SPECTRA: Int
"""Index of u'v' and radius of the lamps, and of their spectra."""


def number(index: Int) -> Float:
    """Read a number of the table, behind the rows of lattice points."""
    raise NotImplementedError


def load_row(index: Int, row: Row) -> None:
    """Copy the row of a lattice point to ``row``."""
    raise NotImplementedError


def tag(index: Int) -> Float:
    """Read the position of the list of entries whose boxes touch the cell above a lattice point, 0 for none."""
    raise NotImplementedError


def warp(wavelength: Float) -> Float:
    """Apply the warp of the phase."""
    raise NotImplementedError


def zeros(count: Int) -> Floats:
    """Create an array of zeros."""
    return [0.0] * count


def empty(count: Int) -> Floats:
    """Create an array whose numbers are set before they are read."""
    return [0.0] * count


def unroll(start: Int, stop: Int) -> range:
    """Range of a loop that is written out in the translation."""
    return range(start, stop)


def copysign(x: Float, sign: Float) -> Float:
    """Give a number that is not negative the sign of another; of 0, either."""
    return x if sign > 0.0 else -x


def sqrt(x: Float) -> Float:
    """Square root."""
    return x**0.5
