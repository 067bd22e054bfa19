"""The eight lattice points around a colour, one after the other: few registers, and texels of four numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        DIM,
        STRIDE,
        Basis,
        Block,
        Coefficients,
        Float,
        Int,
        Place,
        Row,
        Sides,
        empty,
        load_row,
    )
    from uplift.io.export.kernel.lattice import weigh
    from uplift.io.export.kernel.spectra import add_spectrum


def add_nodes(place: Place, basis: Basis, total: Block) -> None:
    """Add the weighted spectra of the eight lattice points."""
    values: Row = empty(STRIDE)
    sides: Sides = empty(6)
    first: Int = weigh(place, sides)
    for corner in range(8):
        load_row(first + corner // 4 * DIM * DIM + corner // 2 % 2 * DIM + corner % 2, values)
        add_spectrum(
            values,
            sides[corner // 4] * sides[2 + corner // 2 % 2] * sides[4 + corner % 2],
            basis,
            total,
        )


def sum_nodes(place: Place, coefficients: Coefficients) -> None:
    """Sum the weighted coefficients of the eight lattice points."""
    values: Row = empty(STRIDE)
    sides: Sides = empty(6)
    first: Int = weigh(place, sides)
    for k in range(COUNT):
        coefficients[k] = 0.0
    for corner in range(8):
        load_row(first + corner // 4 * DIM * DIM + corner // 2 % 2 * DIM + corner % 2, values)
        weight: Float = sides[corner // 4] * sides[2 + corner // 2 % 2] * sides[4 + corner % 2]
        for k in range(COUNT):
            coefficients[k] += weight * values[k]
