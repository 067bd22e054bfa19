"""Mode ``spectra``: the weighted spectra of lattice points and entry, with exact colours."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.entries import add_entry
    from uplift.io.export.kernel.intrinsics import COUNT, WIDTH, Basis, Block, Int, Place, empty
    from uplift.io.export.kernel.moments import tabulate
    from uplift.io.export.kernel.nodes_in_turn import add_nodes


def answer(place: Place, entry: Int, wavelengths: Block, total: Block) -> None:
    """Evaluate a colour that is located."""
    basis: Basis = empty(COUNT * WIDTH)
    for w in range(WIDTH):
        total[w] = 0.5
    tabulate(wavelengths, basis)
    add_nodes(place, basis, total)
    if entry >= 0:
        add_entry(place[3], entry, wavelengths, total)
