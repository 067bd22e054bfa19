"""Spectra of entries, which may have more coefficients than the nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import ENTRIES, ENTRY_COUNT, WIDTH, Block, Float, Int
    from uplift.io.export.kernel.moments import argument, squash


def add_entry(lattice_weight: Float, entry: Int, wavelengths: Block, total: Block) -> None:
    """Mix the spectrum of the lattice in ``total`` with that of an entry."""
    for w in range(WIDTH):
        x: Float = argument(ENTRIES + entry * ENTRY_COUNT, wavelengths[w])
        total[w] = lattice_weight * total[w] + (1.0 - lattice_weight) * squash(x)
