"""Riemann sums (RS): the mean of a spectrum over each of n cells.

Kment 2011, section 5.4 and eq. 5.3. Choices that the text leaves open: the cells have equal widths and cover the range.
A sample on a border counts half for either side, where eq. 5.3 as printed counts it twice. Sums are divided by the
width of their cell, so that products are sums of the same kind. XYZ are products times the integral of the
colour-matching functions over the cell.
"""

from __future__ import annotations

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.representations.dense import STEP, wavelengths, xyz_weights
from uplift.scene.representations.samples import SampleRepresentation


def riemann_sums(count: int) -> SampleRepresentation:
    """Make the representation by ``count`` cells."""
    overlaps = cell_overlaps(count)
    means = overlaps / overlaps.sum(axis=1, keepdims=True)
    return SampleRepresentation(f"RS{count}", "Riemann sums", means.T, overlaps @ xyz_weights())


def cell_overlaps(count: int) -> Array:
    """Fraction (count, 401) of the nanometre around each dense sample that lies in each cell."""
    edges = np.linspace(observer.START - STEP / 2, observer.END + STEP / 2, count + 1)
    low, high = wavelengths() - STEP / 2, wavelengths() + STEP / 2
    overlap = np.minimum(edges[1:, None], high) - np.maximum(edges[:-1, None], low)
    return np.asarray(np.maximum(overlap, 0) / STEP)
