"""Spectra of entries, which may have more coefficients than the nodes, and their mixture with those of the lattice."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        ENTRIES,
        ENTRY_COUNT,
        WIDTH,
        Basis,
        Block,
        Coefficients,
        Float,
        Int,
        empty,
    )
    from uplift.io.export.kernel.moments import argument, deviation, tabulate
    from uplift.io.export.kernel.spectra import evaluate_block


def add_entry(lattice_weight: Float, entry: Int, wavelengths: Block, total: Block) -> None:
    """Mix the spectrum of the lattice in ``total`` with that of an entry."""
    for w in range(WIDTH):
        x: Float = argument(ENTRIES + entry * ENTRY_COUNT, wavelengths[w])
        total[w] = 0.5 + lattice_weight * (total[w] - 0.5) + deviation(1.0 - lattice_weight, x)


def mix(multipliers: Coefficients, lattice_weight: Float, entry: Int, wavelengths: Block, total: Block) -> None:
    """Evaluate the spectrum of multipliers, mixed with that of an entry unless ``entry`` is negative."""
    basis: Basis = empty(COUNT * WIDTH)
    tabulate(wavelengths, basis)
    evaluate_block(multipliers, basis, total)
    if entry >= 0:
        add_entry(lattice_weight, entry, wavelengths, total)
