"""Enhanced Riemann sums (RE): spikes, and Riemann sums of the smooth part.

Kment 2011, section 5.5.
"""

from __future__ import annotations

from uplift.scene.representations.composite import Composite
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.riemann_sums import cell_overlaps, riemann_sums

THRESHOLD = 0.2
"""Relative gradient of spikes, from Kment 2011, section 6.1."""


def enhanced_riemann(count: int) -> Composite:
    """Make the representation with ``count`` cells; a spike meets the mean of the cell that it lies in."""
    decoder = cell_overlaps(count)[:, ::TABLE_STRIDE]
    return Composite(f"RE{count}", "enhanced Riemann sums", riemann_sums(count), decoder, THRESHOLD)
