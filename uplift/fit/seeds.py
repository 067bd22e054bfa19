"""Atlas entries in a lattice: the widths of their boxes, seeds, and the multipliers that nodes start from.

Tódová 2020, "Constrained spectral uplifting", section 3.1.2; docs/mathematics.md, 6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_1976, rgb_to_lab
from uplift.common.arrays import Array, Indices, Mask
from uplift.fit.kriging import DEFAULT
from uplift.fit.prior import Prior
from uplift.lattice import CORNERS, Lattice

NEAR, FAR = 8.0, 16.0
"""ΔE*ab up to which a corner is near its entry, and from which it is far (docs/fidelity.md)."""
MAX_HALF_WIDTH = 1.0
"""Lattice steps: the half width of an entry box without other entries nearby."""
SAME_COLOUR = 1e-6
"""Lattice steps. Entries that are closer have the same colour, and only the first of them is used."""


def half_widths(lattice: Lattice, rgb: Array) -> Array:
    """Half widths (E,) in lattice steps, 0 to 1, of the boxes around entries of linear RGB (E, 3).

    No two boxes overlap: a box extends at most half the distance to the nearest other entry (docs/mathematics.md, 8).
    An entry whose colour an earlier entry has gets 0.
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


@dataclass(frozen=True, eq=False, repr=False)
class Seeds:
    """Nodes (S,) that start from the entries (S,) of linear RGB (E, 3).

    ``primary`` (S,) marks the node nearest to its entry. ``crowded`` are entries whose nearest node a closer one has.
    """

    rgb: Array
    points: Indices
    entry: Indices
    primary: Mask
    crowded: tuple[int, ...]


def seed(lattice: Lattice, rgb: Array) -> Seeds:
    """Assign nodes to atlas entries of linear RGB (E, 3), independently of the order of the entries.

    Every entry gets its nearest node, unless a closer entry owns it. Then, in rounds, every entry gets the nearest free
    corner of its cell: the "better approach" of the thesis.
    """
    cells, _ = lattice.corners(rgb)
    distance = np.linalg.norm(lattice.points[cells] - rgb[:, None, :], axis=-1)
    by_distance = np.argsort(distance, axis=1, kind="stable")
    queue = np.take_along_axis(cells, by_distance, axis=1)
    nearest = np.take_along_axis(distance, by_distance, axis=1)[:, 0]
    order = np.lexsort([*rgb.T, nearest])
    owner: dict[int, int] = {}
    crowded = [int(entry) for entry in order if owner.setdefault(int(queue[entry, 0]), int(entry)) != entry]
    # Then the corners of the cells, one for every entry in turn, nearest first.
    primaries = len(owner)
    for _ in CORNERS:
        for entry in order:
            free = next((int(point) for point in queue[entry] if point not in owner), None)
            if free is not None:
                owner[free] = int(entry)
    points, entries = (np.array(list(each), dtype=np.int64) for each in (owner, owner.values()))
    return Seeds(rgb, points, entries, np.arange(len(owner)) < primaries, tuple(crowded))


@dataclass(frozen=True)
class EntryBlend:
    """Weight of an entry in the start of the corners of its cell; the rest is the prior.

    ``near`` is the weight at corners up to `NEAR` ΔE*ab from the entry, ``far`` that from `FAR`; it changes linearly
    between them.
    """

    near: float
    far: float = 0.0

    def __call__(self, distance: Array) -> Array:
        """Weight (n,) at ΔE*ab (n,) from the entry."""
        return np.interp(distance, (NEAR, FAR), (self.near, self.far))


FULL_ENTRY = EntryBlend(near=1.0, far=1.0)
"""Tódová 2020, section 3.1.2."""


def learnt_blend(prior: Prior) -> EntryBlend:
    """Return the blend ½ + ½ min(ν / 0.3, 1) near an entry, with the learnt nugget ν.

    Entries of an atlas with a small nugget are predicted by others. Materials of such an atlas between its entries are
    nearer to the prior, and only half of an entry's own deviation is expected at the corners. Corners of coarse
    lattices whose colour is another one start from the prior alone.
    """
    if prior.kriging is None:
        return EntryBlend(near=1.0)
    return EntryBlend(near=(1 + min(prior.kriging.kernel.nugget / DEFAULT.nugget, 1)) / 2)


@dataclass(frozen=True, eq=False, repr=False)
class InitialGuess:
    """What nodes start from: entries (E, C) around their colours, elsewhere the prior.

    The primary node of an entry starts from the entry alone, the other corners of its cell from a blend.
    """

    prior: Prior
    seeds: Seeds
    entries: Array
    blend: EntryBlend = FULL_ENTRY

    def __call__(self, points: Indices, rgb: Array) -> Array:
        """Multipliers (k, C) of nodes (k,), which are fitted to linear RGB (k, 3)."""
        model, seeds = self.prior.model, self.seeds
        multipliers = self.prior(rgb)
        _, seeded, row = np.intersect1d(points, seeds.points, assume_unique=True, return_indices=True)
        entry = seeds.entry[row]
        own, expected = self.entries[entry], multipliers[seeded]

        node_lab, entry_lab = (rgb_to_lab(self.prior.sensor, each) for each in (rgb[seeded], seeds.rgb))
        weight = np.where(seeds.primary[row], 1.0, self.blend(delta_e_1976(node_lab, entry_lab[entry])))
        full, mixed = weight == 1, (weight > 0) & (weight < 1)
        multipliers[seeded[full]] = own[full]
        # c = w c_entry + (1 − w) c_prior: coefficients mix as spectra do.
        part = weight[mixed, None]
        blend = part * model.to_storage(own[mixed]) + (1 - part) * model.to_storage(expected[mixed])
        multipliers[seeded[mixed]] = model.from_storage(blend)
        return multipliers
