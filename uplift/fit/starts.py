"""What the points of a lattice start from: atlas entries around their colours, elsewhere the prior."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.fit.prior import Prior
from uplift.fit.seed import Seeds
from uplift.lattice import NO_ENTRY


@dataclass(frozen=True, eq=False, repr=False)
class Starts:
    """Expected multipliers of lattice points.

    Parameters
    ----------
    prior : Prior
        Spectra expected at the colours of the points.
    seeds : Seeds
        Points around the colours of atlas entries.
    entries : ndarray, shape (E, C)
        Multipliers of the atlas entries.
    corner_share : float, default 1
        Share, 0 to 1, of the entry in the start of the corners of its cell; the rest is the prior. The primary point
        starts from the entry alone.
    """

    prior: Prior
    seeds: Seeds
    entries: Array
    corner_share: float = 1.0

    def __call__(self, points: Indices, rgb: Array) -> Array:
        """Multipliers (k, C) of points (k,), which are fitted to linear RGB (k, 3)."""
        multipliers = self.prior(rgb)
        row = self._seed_rows(points)
        seeded = np.flatnonzero(row != NO_ENTRY)
        own = self.entries[self.seeds.entry[row[seeded]]]
        shared = (
            ~self.seeds.primary[row[seeded]] if self.corner_share < 1 else np.zeros(len(seeded), dtype=bool)
        )
        own[shared] = self._mix(own[shared], multipliers[seeded[shared]])
        multipliers[seeded] = own
        return multipliers

    def describe(self) -> dict[str, float]:
        """Return the learnt parameters, for the provenance of cubes.

        Returns
        -------
        dict
            Those of the prior, and ``corner_share``; empty without an atlas.
        """
        learnt = self.prior.describe()
        return learnt and {**learnt, "corner_share": self.corner_share}

    def _mix(self, entry: Array, expected: Array) -> Array:
        """Multipliers (k, C) of mixed spectra: coefficients mix as spectra do."""
        model, share = self.prior.model, self.corner_share
        mixed = share * model.to_storage(entry) + (1 - share) * model.to_storage(expected)
        return model.from_storage(mixed)

    def _seed_rows(self, points: Indices) -> Indices:
        """Row of each point (k,) among the seeds, or `NO_ENTRY`."""
        order, numbers = self._by_number
        place = np.searchsorted(numbers, points)
        found = np.append(numbers, NO_ENTRY)[place] == points
        return np.where(found, np.append(order, NO_ENTRY)[place], NO_ENTRY)

    @cached_property
    def _by_number(self) -> tuple[Indices, Indices]:
        """Seeds in the order of their point numbers, and these numbers."""
        order = np.argsort(self.seeds.points, kind="stable")
        return order, self.seeds.points[order]
