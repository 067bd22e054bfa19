"""Widths of the boxes around atlas entries (docs/mathematics.md, 8)."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.lattice.lattice import Lattice

MAX_HALF_WIDTH = 1.0
"""Lattice steps: the half width of an entry box without other entries nearby."""
SAME_COLOUR = 1e-6
"""Lattice steps. Entries that are closer have the same colour, and only the first of them is used."""


def half_widths(lattice: Lattice, rgb: Array) -> Array:
    """Return the half widths of entry boxes.

    No two boxes overlap: a box extends at most half the distance to the nearest other entry.

    Parameters
    ----------
    lattice : Lattice
        The lattice that the boxes lie in.
    rgb : ndarray, shape (E, 3)
        Linear RGB of the entries.

    Returns
    -------
    ndarray, shape (E,)
        Lattice steps, 0 to 1. 0 for an entry whose colour an earlier entry has.
    """
    from scipy.spatial import KDTree

    if len(rgb) < 2:
        return np.full(len(rgb), MAX_HALF_WIDTH)
    steps = lattice.to_steps(rgb)
    unique = np.ones(len(rgb), dtype=bool)
    unique[[later for _, later in KDTree(steps).query_pairs(SAME_COLOUR, p=np.inf)]] = False
    widths = np.zeros(len(rgb))
    nearest = KDTree(steps[unique]).query(steps[unique], k=2, p=np.inf)[0][:, 1]
    widths[unique] = np.minimum(MAX_HALF_WIDTH, nearest / 2)
    return widths
