"""Riemann sums (RS): the mean of a spectrum over each of n cells.

Kment 2011, 5.4 (eq. 5.3). Where the text leaves a choice open: the cells are equally wide, and together the whole
range; a sample that lies on a border counts to either side by half, where eq. 5.3 as it is printed counts it twice;
sums are divided by the width of their cell, so that products are sums of the same kind; XYZ are products times the
integral of the colour-matching functions over the cell.
"""

from __future__ import annotations

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.representations.dense import STEP, wavelengths, xyz_weights
from uplift.scene.representations.samples import SampleRepresentation


def riemann_sums(count: int) -> SampleRepresentation:
    """``count`` cells."""
    shares = cell_overlaps(count)
    means = shares / shares.sum(axis=1, keepdims=True)
    return SampleRepresentation(f"RS{count}", "Riemann sums", means.T, shares @ xyz_weights())


def cell_overlaps(count: int) -> Array:
    """(count, 401) the share of each dense sample's nanometre that lies in each cell."""
    edges = np.linspace(observer.START - STEP / 2, observer.END + STEP / 2, count + 1)
    below, above = wavelengths() - STEP / 2, wavelengths() + STEP / 2
    shared = np.minimum(edges[1:, None], above) - np.maximum(edges[:-1, None], below)
    return np.asarray(np.maximum(shared, 0) / STEP)
