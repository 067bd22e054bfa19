"""Lamps in discs over chromaticity: within a disc, answers blend to the lamp at its centre."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

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
        places, lists = self._candidates
        u, v = _bins(uv).T
        listed = places.take(u * BINS + v)
        near = np.flatnonzero(listed >= 0)
        candidates = lists[listed[near]]
        row, column = np.nonzero(candidates >= 0)
        rows, entry = near[row], candidates[row, column]
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
    def _candidates(self) -> tuple[Indices, Indices]:
        """The lamps whose discs reach into each bin.

        (BINS²,) rows of the bins in the second array, −1 for bins without lamps; (m, k) numbers of lamps, the rest −1.
        """
        low, high = _bins(self.uv - self.radius[:, None]), _bins(self.uv + self.radius[:, None])
        found: dict[int, list[int]] = {}
        for number, (first, last) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
            for u, v in product(*map(range, first, (last[0] + 1, last[1] + 1))):
                found.setdefault(u * BINS + v, []).append(number)
        places = np.full(BINS**2, -1)
        lists = np.full((len(found), max(map(len, found.values()), default=0)), -1)
        for row, (place, numbers) in enumerate(found.items()):
            places[place] = row
            lists[row, : len(numbers)] = numbers
        return places, lists


def _bins(uv: Array) -> Indices:
    """Bins (n, 2) along u′ and v′."""
    return np.clip(uv * float(BINS), 0, BINS - 1).astype(np.int64)
