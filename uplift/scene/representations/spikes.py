"""Spikes and the smooth spectrum beneath them: segmentation by relative gradient.

Deville, Merzouk, Cazier & Paul 1994, "Spectral data modeling for a lighting application", as Kment 2011, 5.4 has it.
Where the text leaves a choice open: the gradient is that between two samples of the 5 nm table, relative to the
highest sample of the spectrum; the smooth part is the largest spectrum below the given one that is nowhere steeper
than the threshold, and the spikes are what stands above it.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array, Indices
from uplift.scene.representations.dense import TABLE_STRIDE, hat_functions, xyz_weights

NOISE = 1e-9
"""Of the highest sample: rounding leaves as much above the smooth part."""
FLOATS = 2
"""Stored of a spike: where it is, and how high."""


class Spikes(NamedTuple):
    """``heights`` (n, P) at ``places`` (P,), numbers of samples of the 5 nm table; 0 where a spectrum has no spike."""

    places: Indices
    heights: Array

    @property
    def storage(self) -> Array:
        """(n,) numbers that the spikes of each spectrum take."""
        return FLOATS * (self.heights != 0).sum(axis=1, dtype=float)


def split_spikes(spectra: Array, threshold: float) -> tuple[Array, Spikes]:
    """The smooth part (n, 401) of dense spectra (n, 401), linear in 5 nm, and the spikes upon it."""
    table = spectra[:, ::TABLE_STRIDE]
    steepest = threshold * table.max(axis=1, keepdims=True)
    smooth = table.copy()
    # Whatever is too steep for its neighbour is cut down to it; one sweep each way settles all.
    for place in range(1, smooth.shape[1]):
        smooth[:, place] = np.minimum(smooth[:, place], smooth[:, place - 1] + steepest[:, 0])
    for place in reversed(range(smooth.shape[1] - 1)):
        smooth[:, place] = np.minimum(smooth[:, place], smooth[:, place + 1] + steepest[:, 0])
    heights = table - smooth
    heights[heights < NOISE * table.max(axis=1, keepdims=True)] = 0
    places = np.flatnonzero(heights.any(axis=0))
    return (table - heights) @ hat_functions(observer.grid()), Spikes(places, heights[:, places])


def spread(spikes: Spikes, places: Indices) -> Array:
    """Their heights (n, Q) at ``places`` (Q,), which hold all of theirs."""
    heights = np.zeros((len(spikes.heights), len(places)))
    heights[:, np.searchsorted(places, spikes.places)] = spikes.heights
    return heights


@functools.cache
def triangles() -> Array:
    """(81, 3) XYZ of a spike of height 1 at each place: a triangle as wide as linear interpolation makes it."""
    return hat_functions(observer.grid()) @ xyz_weights()
