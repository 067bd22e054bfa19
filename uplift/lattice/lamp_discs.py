"""Lamps in discs over chromaticity: within a disc, answers blend to the lamp at its centre."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array, Indices

BINS = 256
"""Bins along u′ and v′, which range from 0 to 1."""
MIN_RADIUS = 1e-4
"""Radius in u′v′ below which single precision does not resolve a disc."""


@dataclass(frozen=True, eq=False)
class DiscHits:
    """Chromaticities in discs.

    Parameters
    ----------
    rows : ndarray of int, shape (k,)
        Numbers of the chromaticities.
    entry : ndarray of int, shape (k,)
        Numbers of the lamps.
    share : ndarray, shape (k,)
        Share of the lamp in the answer: 1 at its chromaticity, 0 on the circle.
    exit_uv : ndarray, shape (k, 2)
        Where the ray from the lamp through the chromaticity leaves the disc: the rest of the answer is that of the
        lattice there.
    """

    rows: Indices
    entry: Indices
    share: Array
    exit_uv: Array


@dataclass(frozen=True, eq=False)
class LampEntries:
    """Measured lamps that a table returns exactly at their chromaticities.

    Parameters
    ----------
    names : tuple of str
        Names, each once.
    uv : ndarray, shape (E, 2)
        u′v′ of the lamps.
    spectra : ndarray, shape (E, N)
        Power of unit X + 15 Y + 3 Z.
    radius : ndarray, shape (E,)
        Radius in u′v′ of the disc around each lamp in which answers blend to it. Discs do not overlap.
    """

    names: tuple[str, ...]
    uv: Array
    spectra: Array
    radius: Array

    def locate(self, uv: Array) -> DiscHits:
        """Find the discs of chromaticities.

        Parameters
        ----------
        uv : ndarray, shape (n, 2)
            u′v′.

        Returns
        -------
        DiscHits
            Those in a disc.
        """
        bins = _bins(uv)
        near = self._candidates[bins[:, 0], bins[:, 1]]
        rows, column = np.nonzero(near >= 0)
        entry = near[rows, column]
        offset = uv[rows] - self.uv[entry]
        distance, radius = np.hypot(offset[:, 0], offset[:, 1]), self.radius[entry]
        inside = distance < radius
        rows, entry, radius = rows[inside], entry[inside], radius[inside]
        offset, distance = offset[inside], distance[inside]
        direction = np.divide(
            offset, distance[:, None], out=np.tile([1.0, 0.0], (len(rows), 1)), where=distance[:, None] > 0
        )
        return DiscHits(rows, entry, 1 - distance / radius, self.uv[entry] + direction * radius[:, None])

    @cached_property
    def _candidates(self) -> Indices:
        """(BINS, BINS, m) numbers of the lamps whose discs reach into each bin, the rest −1."""
        low, high = _bins(self.uv - self.radius[:, None]), _bins(self.uv + self.radius[:, None])
        counts = np.zeros((BINS, BINS), dtype=np.int64)
        for first, last in zip(low, high + 1, strict=True):
            counts[first[0] : last[0], first[1] : last[1]] += 1
        found = np.full((BINS, BINS, int(counts.max(initial=0))), -1)
        counts[:] = 0
        for number, (first, last) in enumerate(zip(low, high + 1, strict=True)):
            for i in range(first[0], last[0]):
                for j in range(first[1], last[1]):
                    found[i, j, counts[i, j]] = number
                    counts[i, j] += 1
        return found


def _bins(uv: Array) -> Indices:
    return np.asarray(np.clip(uv * BINS, 0, BINS - 1), dtype=np.int64)
