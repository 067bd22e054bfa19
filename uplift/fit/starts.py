"""What the points of a lattice start from: atlas entries around their colours, elsewhere the prior."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry.delta_e import delta_e_1976, rgb_to_lab
from uplift.common.arrays import Array, Indices
from uplift.fit.corner_share import ENTRY_ALONE, CornerShare
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
    corner_share : CornerShare, default `ENTRY_ALONE`
        Share of the entry in the start of the corners of its cell; the rest is the prior. The primary point starts from
        the entry alone.
    """

    prior: Prior
    seeds: Seeds
    entries: Array
    corner_share: CornerShare = ENTRY_ALONE

    def __call__(self, points: Indices, rgb: Array) -> Array:
        """Multipliers (k, C) of points (k,), which are fitted to linear RGB (k, 3)."""
        multipliers = self.prior(rgb)
        row = self._seed_rows(points)
        seeded = np.flatnonzero(row != NO_ENTRY)
        own, share = self.entries[self.seeds.entry[row[seeded]]], self._share(row[seeded], rgb[seeded])
        whole, mixed = share == 1, (share > 0) & (share < 1)
        multipliers[seeded[whole]] = own[whole]
        multipliers[seeded[mixed]] = self._mix(share[mixed], own[mixed], multipliers[seeded[mixed]])
        return multipliers

    def describe(self) -> dict[str, float]:
        """Return the learnt parameters, for the provenance of cubes.

        Returns
        -------
        dict
            Those of the prior, and ``corner_share``, that of corners near their entry; empty without an atlas.
        """
        learnt = self.prior.describe()
        return learnt and {**learnt, "corner_share": self.corner_share.near}

    def _share(self, row: Indices, rgb: Array) -> Array:
        """Share (k,) of the entry in seeds (k,), which are fitted to linear RGB (k, 3)."""
        nodes, entries = (rgb_to_lab(self.prior.sensor, each) for each in (rgb, self.seeds.rgb))
        distance = delta_e_1976(nodes, entries[self.seeds.entry[row]])
        return np.where(self.seeds.primary[row], 1.0, self.corner_share(distance))

    def _mix(self, share: Array, entry: Array, expected: Array) -> Array:
        """Multipliers (k, C) of spectra mixed by shares (k,): coefficients mix as spectra do."""
        model, share = self.prior.model, share[:, None]
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
