"""How far around its colour an atlas entry leads answers over to its own spectrum (docs/mathematics.md, 8)."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.lattice import Lattice

FARTHEST = 1.0
"""Lattice steps, for an entry by itself."""
SAME = 1e-6
"""Steps at which two entries have the same colour, so that only one of them can be answered."""


def half_widths(lattice: Lattice, rgb: Array) -> Array:
    """Lattice steps (E,) to the faces of the box around each entry of linear RGB (E, 3).

    Half the way to the nearest other entry at the most, so that no two boxes overlap; 0 for an entry whose
    colour an earlier one has.
    """
    from scipy.spatial import KDTree

    if len(rgb) < 2:
        return np.full(len(rgb), FARTHEST)
    steps = lattice.steps_along(rgb)
    tree = KDTree(steps)
    earlier = {later for _, later in tree.query_pairs(SAME, p=np.inf)}
    kept = np.array([row not in earlier for row in range(len(rgb))])
    found = np.zeros(len(rgb))
    apart = KDTree(steps[kept]).query(steps[kept], k=2, p=np.inf)[0][:, 1]
    found[kept] = np.minimum(FARTHEST, apart / 2)
    return found
