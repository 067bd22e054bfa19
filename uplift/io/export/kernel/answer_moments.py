"""Mode ``moments``: one spectrum of the weighted coefficients of the lattice, mixed with that of the entry."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.entries import add_entry
    from uplift.io.export.kernel.intrinsics import COUNT, WIDTH, Basis, Block, Coefficients, Int, Place, zeros
    from uplift.io.export.kernel.lattice import sum_nodes
    from uplift.io.export.kernel.moments import multipliers_of, tabulate
    from uplift.io.export.kernel.spectra import evaluate_block


def answer(place: Place, entry: Int, wavelengths: Block, total: Block) -> None:
    """Evaluate a colour that is located."""
    basis: Basis = zeros(COUNT * WIDTH)
    coefficients: Coefficients = zeros(COUNT)
    multipliers: Coefficients = zeros(COUNT)
    sum_nodes(place, coefficients)
    multipliers_of(coefficients, multipliers)
    tabulate(wavelengths, basis)
    evaluate_block(multipliers, basis, total)
    if entry >= 0:
        add_entry(place[3], entry, wavelengths, total)
