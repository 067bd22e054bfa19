"""The weighted spectra of the eight lattice points around a colour, point by point: needs few registers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        DIM,
        STRIDE,
        Basis,
        Block,
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
