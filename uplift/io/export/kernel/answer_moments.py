"""Mode ``moments``: one spectrum of the weighted coefficients of the lattice, mixed with that of the entry."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.entries import mix
    from uplift.io.export.kernel.intrinsics import COUNT, Block, Coefficients, Int, Place, empty
    from uplift.io.export.kernel.moments import multipliers_of
    from uplift.io.export.kernel.nodes_in_turn import sum_nodes


def answer(place: Place, entry: Int, wavelengths: Block, total: Block) -> None:
    """Evaluate a colour that is located."""
    coefficients: Coefficients = empty(COUNT)
    multipliers: Coefficients = empty(COUNT)
    sum_nodes(place, coefficients)
    multipliers_of(coefficients, multipliers)
    mix(multipliers, place[3], entry, wavelengths, total)
