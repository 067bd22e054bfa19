"""Coefficients of a colour, which are linear in its spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        LATTICE,
        STRIDE,
        Coefficients,
        Float,
        Int,
        Place,
        number,
    )
    from uplift.io.export.kernel.nodes_in_turn import sum_nodes


def sum_coefficients(place: Place, entry: Int, coefficients: Coefficients) -> None:
    """Sum the weighted coefficients of the lattice and of an entry, in as many coefficients."""
    sum_nodes(place, coefficients)
    if entry >= 0:
        for k in range(COUNT):
            value: Float = number((LATTICE + entry) * STRIDE + k)
            coefficients[k] = place[3] * coefficients[k] + (1.0 - place[3]) * value
