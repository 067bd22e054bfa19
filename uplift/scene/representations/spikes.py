"""Decomposition of a spectrum into a smooth part and spikes by the relative gradient.

Deville, Merzouk, Cazier & Paul 1994, "Spectral data modeling for a lighting application", as described in Kment 2011,
section 5.4. Choices that the text leaves open: the gradient is that between two samples of the 5 nm table, relative to
the highest sample of the spectrum. The smooth part is the largest spectrum below the given one that is nowhere steeper
than the threshold. The spikes are the difference.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array, Indices
from uplift.scene.representations.dense import TABLE_STRIDE, hat_functions, xyz_weights

NOISE = 1e-9
"""Heights below this fraction of the highest sample are rounding."""
NUMBERS_PER_SPIKE = 2
"""A position and a height."""


class Spikes(NamedTuple):
    """Heights (n, P) of spikes at ``positions`` (P,), indices of the 5 nm table; 0 where a spectrum has no spike."""

    positions: Indices
    heights: Array

    @property
    def storage(self) -> Array:
        """Numbers (n,) stored for the spikes of each spectrum."""
        return NUMBERS_PER_SPIKE * (self.heights != 0).sum(axis=1, dtype=float)


def split_spikes(spectra: Array, threshold: float) -> tuple[Array, Spikes]:
    """Split dense spectra (n, 401) into a smooth part (n, 401), linear between 5 nm, and spikes."""
    table = spectra[:, ::TABLE_STRIDE]
    highest = table.max(axis=1)
    step = threshold * highest
    smooth = table.copy()
    # Limit the gradient by one sweep in each direction.
    for index in range(1, smooth.shape[1]):
        smooth[:, index] = np.minimum(smooth[:, index], smooth[:, index - 1] + step)
    for index in reversed(range(smooth.shape[1] - 1)):
        smooth[:, index] = np.minimum(smooth[:, index], smooth[:, index + 1] + step)
    heights = table - smooth
    heights[heights < NOISE * highest[:, None]] = 0
    positions = np.flatnonzero(heights.any(axis=0))
    return (table - heights) @ hat_functions(observer.grid()), Spikes(positions, heights[:, positions])


def heights_at(spikes: Spikes, positions: Indices) -> Array:
    """Heights (n, Q) at ``positions`` (Q,), a superset of those of the spikes."""
    heights = np.zeros((len(spikes.heights), len(positions)))
    heights[:, np.searchsorted(positions, spikes.positions)] = spikes.heights
    return heights


@functools.cache
def spike_xyz() -> Array:
    """XYZ (81, 3) of a spike of height 1 at each position: a triangle as wide as linear interpolation makes it."""
    return hat_functions(observer.grid()) @ xyz_weights()
