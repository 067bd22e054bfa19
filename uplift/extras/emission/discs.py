"""Measured lamps in discs over u′v′: within a disc, answers blend to the lamp at its
centre.
"""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, distances
from uplift.common.errors import unknown_name
from uplift.extras.emission.lattice import (
    ChromaticityLattice,
    chromaticity,
    cross,
    unit_power,
)

BINS = 256
"""Bins along u′ and v′, which range from 0 to 1."""
MIN_RADIUS = 1e-4
"""Radius in u′v′ below which single precision does not resolve a disc."""
MAX_RADIUS = 0.01
"""Largest radius of a disc of a build in u′v′."""
SAME_CHROMATICITY = 1e-5
"""Distance in u′v′ at which two constraints are one: they have one RGB."""
CLEARANCE = 2e-3
"""Distance in u′v′ that other lamps keep from constraints: about two just noticeable
differences.
"""


@dataclass(frozen=True, eq=False)
class Lamps:
    """Spectral powers of lamps."""

    names: tuple[str, ...]
    power: Array
    """(L, N) Power at the wavelengths of a sensor, not negative, relative to the
    equal-energy light of luminance 1.
    """

    def __len__(self) -> int:
        return len(self.names)

    def without(self, names: Collection[str]) -> "Lamps":
        """Leave out lamps."""
        for name in names:
            if name not in self.names:
                raise unknown_name(name, self.names, "lamp")
        return self.only(~np.isin(self.names, list(names)))

    def only(self, lamps: Mask | Indices | list[int]) -> "Lamps":
        """Some of the lamps, by numbers or a mask (L,)."""
        return Lamps(tuple(np.array(self.names)[lamps].tolist()), self.power[lamps])


@dataclass(frozen=True, eq=False)
class DiscHits:
    """Those of n chromaticities that lie in discs.

    `rows` and `entry` (k,) number the chromaticities and their lamps. `share` (k,) of
    the answer is the lamp: 1 at its chromaticity, 0 on the circle. The rest is the
    answer of the lattice at `exit_uv` (k, 2), where the ray from the lamp through the
    chromaticity leaves the disc.
    """

    rows: Indices
    entry: Indices
    share: Array
    exit_uv: Array


@dataclass(frozen=True, eq=False)
class LampEntries:
    """Measured lamps that a table returns exactly: E names, each once, u′v′ (E, 2),
    spectra (E, N) and radii (E,).

    Spectra have unit X + 15 Y + 3 Z. The radius is that of the disc, in u′v′; discs do
    not overlap.
    """

    names: tuple[str, ...]
    uv: Array
    spectra: Array
    radius: Array

    def locate(self, uv: Array) -> DiscHits:
        """Find the discs of chromaticities (n, 2)."""
        places, lists = self._candidates
        u, v = _bins(uv, BINS).T
        listed = places.take(u * BINS + v)
        near = np.flatnonzero(listed >= 0)
        candidates = lists[listed[near]]
        row, column = np.nonzero(candidates >= 0)
        rows = near[row]
        entry = candidates[row, column]
        offset = uv[rows] - self.uv[entry]
        inside = np.hypot(*offset.T) < self.radius[entry]
        rows = rows[inside]
        entry = entry[inside]
        offset = offset[inside]
        radius = self.radius[entry]
        distance = np.hypot(*offset.T)
        direction = np.divide(
            offset,
            distance[:, None],
            out=np.tile([1.0, 0.0], (len(rows), 1)),
            where=distance[:, None] > 0,
        )
        return DiscHits(
            rows,
            entry,
            1 - distance / radius,
            self.uv[entry] + direction * radius[:, None],
        )

    @cached_property
    def _candidates(self) -> tuple[Indices, Indices]:
        """The lamps whose discs reach into each bin.

        (BINS²,) rows of the bins in the second array, −1 for bins without lamps; (m, k)
        numbers of lamps, the rest −1.
        """
        bins = touched_bins(self.uv, self.radius, BINS)
        places = np.full(BINS**2, -1)
        lists = np.full((len(bins), max(map(len, bins.values()), default=0)), -1)
        for row, ((v, u), numbers) in enumerate(bins.items()):
            places[u * BINS + v] = row
            lists[row, : len(numbers)] = numbers
        return places, lists


def lamp_entries(
    constraints: Lamps, others: Lamps, lattice: ChromaticityLattice, radiometry: Array
) -> tuple[LampEntries, tuple[tuple[str, str], ...]]:
    """Give each lamp a disc that reaches half of the way to the next one, and at most
    `MAX_RADIUS`, in the lattice.

    Other lamps are exact unless they are close to a constraint, or have nearly the
    chromaticity of another lamp: of two lamps of one RGB neither is exact, and the
    expected light averages them. `radiometry` (N, 3) leads from power to XYZ. Returns
    also the constraints that are left out, each with an earlier one of the same
    chromaticity.
    """
    power, uv = _unit(constraints.power, radiometry)
    kept = list[int]()
    duplicates = list[tuple[str, str]]()
    for row, name in enumerate(constraints.names):
        twins = [
            other
            for other in kept
            if np.linalg.norm(uv[row] - uv[other]) <= SAME_CHROMATICITY
        ]
        if twins:
            duplicates.append((name, constraints.names[twins[0]]))
        else:
            kept.append(row)
    more, more_uv = _unit(others.power, radiometry)
    clear = np.flatnonzero(
        distances(more_uv, uv[kept]).min(axis=1, initial=np.inf) > CLEARANCE
    )
    names = constraints.only(kept).names + others.only(clear).names
    uv = np.concatenate([uv[kept], more_uv[clear]])
    spectra = np.concatenate([power[kept], more[clear]])
    apart = distances(uv, uv) + np.diag(np.full(len(uv), np.inf))
    radius = np.minimum(apart.min(axis=1) / 2, MAX_RADIUS)
    radius = np.minimum(radius, _to_rim(uv, lattice))
    resolved = np.flatnonzero(
        (np.arange(len(names)) < len(kept)) | (radius >= MIN_RADIUS)
    )
    entries = LampEntries(
        tuple(names[row] for row in resolved),
        uv[resolved],
        spectra[resolved],
        radius[resolved],
    )
    return entries, tuple(duplicates)


def touched_bins(
    uv: Array, radius: Array, count: int
) -> dict[tuple[int, int], list[int]]:
    """Return the numbers of the discs that reach into each of ``count``² bins, by the
    bin along v′ and u′.
    """
    low, high = (_bins(uv + sign * radius[:, None], count).tolist() for sign in (-1, 1))
    bins = dict[tuple[int, int], list[int]]()
    for number, ((left, bottom), (right, top)) in enumerate(
        zip(low, high, strict=True)
    ):
        for place in product(range(bottom, top + 1), range(left, right + 1)):
            bins.setdefault(place, []).append(number)
    return bins


def _bins(uv: Array, count: int) -> Indices:
    """Bins (n, 2) along u′ and v′."""
    return np.clip(uv * float(count), 0, count - 1).astype(np.int64)


def _unit(power: Array, radiometry: Array) -> tuple[Array, Array]:
    """Power of unit X + 15 Y + 3 Z, and u′v′."""
    unit = unit_power(power, radiometry)
    return unit, chromaticity(unit @ radiometry)


def _to_rim(uv: Array, lattice: ChromaticityLattice) -> Array:
    """Distances (n,) from the polygon; 0 on it."""
    edges = np.roll(lattice.knots, -1, axis=0) - lattice.knots
    offset = uv[:, None] - lattice.knots
    return (cross(edges, offset) / np.linalg.norm(edges, axis=1)).min(axis=1).clip(0.0)
