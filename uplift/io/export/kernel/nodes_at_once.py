"""The eight lattice points around a colour together, for processors that vectorise loops.

First the polynomials of all points, then their arc tangents: the coefficients of a pass stay in registers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        DIM,
        STRIDE,
        WIDTH,
        Basis,
        Block,
        Coefficients,
        Corners,
        Float,
        Int,
        Place,
        Row,
        Sides,
        Weights,
        empty,
        load_row,
        number,
        unroll,
    )
    from uplift.io.export.kernel.lattice import weigh
    from uplift.io.export.kernel.moments import deviation
    from uplift.io.export.kernel.spectra import polynomial


def add_nodes(place: Place, basis: Basis, total: Block) -> None:
    """Add the weighted spectra of the eight lattice points."""
    values: Row = empty(STRIDE)
    sides: Sides = empty(6)
    weights: Weights = empty(8)
    polynomials: Corners = empty(8 * WIDTH)
    first: Int = weigh(place, sides)
    for corner in range(8):
        load_row(first + corner // 4 * DIM * DIM + corner // 2 % 2 * DIM + corner % 2, values)
        weights[corner] = sides[corner // 4] * sides[2 + corner // 2 % 2] * sides[4 + corner % 2]
        for w in range(WIDTH):
            polynomials[corner * WIDTH + w] = polynomial(values, basis, w)
    for w in range(WIDTH):
        x: Float = total[w]
        for corner in unroll(0, 8):
            x += deviation(weights[corner], polynomials[corner * WIDTH + w])
        total[w] = x


def sum_nodes(place: Place, coefficients: Coefficients) -> None:
    """Sum the weighted coefficients of the eight lattice points."""
    mixed: Row = empty(STRIDE)
    sides: Sides = empty(6)
    first: Int = weigh(place, sides) * STRIDE
    for k in range(STRIDE):
        x: Float = 0.0
        for corner in unroll(0, 8):
            x += (
                sides[corner // 4]
                * sides[2 + corner // 2 % 2]
                * sides[4 + corner % 2]
                * number(first + (corner // 4 * DIM * DIM + corner // 2 % 2 * DIM + corner % 2) * STRIDE + k)
            )
        mixed[k] = x
    for k in range(COUNT):
        coefficients[k] = mixed[k]
