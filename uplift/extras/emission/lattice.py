"""The lattice over CIE 1976 u′v′: spokes from white to knots on the spectral locus,
crossed by rings.
"""

# Node (k, j) lies on the segment from white to knot k, at the fraction of ring j. A
# cell lies between two neighbouring knots and two neighbouring rings. Its two ring
# sides are parallel, so weights that are linear along the rings and across them give
# back the chromaticity exactly. With every spectrum at its node scaled to X + 15 Y + 3
# Z = 1, the denominator of u′v′, so do the weighted spectra.

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import OptionError
from uplift.common.text import pluralise

DENOMINATOR = np.array([1.0, 15.0, 3.0])
"""Weights of X, Y and Z in the denominator of u′ and v′."""
LOCUS_TOLERANCE = 3e-4
"""Share of the distance from white by which lights may lie beyond the polygon, as the
spectral locus bends inward.
"""
TINY = float(np.finfo(np.float64).tiny)


def cross(first: Array, second: Array) -> Array:
    """Compute the cross products (...) of vectors (..., 2)."""
    return first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]


def unit_power(power: Array, radiometry: Array) -> Array:
    """Scale spectra (..., N) to unit X + 15 Y + 3 Z; ``radiometry`` (N, 3) leads from
    power to XYZ.
    """
    return power / (power @ radiometry @ DENOMINATOR)[..., None]


def chromaticity(xyz: Array) -> Array:
    """Compute u′v′ (..., 2) of XYZ (..., 3), not black: CIE 015:2018, 8.2.1.1."""
    return xyz[..., :2] * (4.0, 9.0) / (xyz @ DENOMINATOR)[..., None]


def unit_xyz(uv: Array) -> Array:
    """Compute XYZ (..., 3) of unit X + 15 Y + 3 Z of u′v′ (..., 2), the inverse of
    `chromaticity`.
    """
    x = uv[..., 0] / 4
    y = uv[..., 1] / 9
    return np.stack([x, y, (1 - x - 15 * y) / 3], axis=-1)


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of n colours: knot and ring of the lowest corner, and positions from 0 to 1
    to the next ones, all (n,).
    """

    sector: Indices
    ring: Indices
    along: Array
    across: Array

    @property
    def weights(self) -> Array:
        """(n, 4) weights of the corners; they sum to 1."""
        t = self.along
        s = self.across
        return np.stack([(1 - t) * (1 - s), (1 - t) * s, t * (1 - s), t * s], axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class ChromaticityLattice:
    """Nodes over all chromaticities of lights.

    `white` (2,) is the centre. `knots` (K, 2) are the corners, counterclockwise, of a
    polygon that the centre views completely. `rings` (R,) are fractions of the way from
    the centre to the polygon, increasing from 0 to 1. Others raise `OptionError`.
    """

    white: Array
    knots: Array
    rings: Array

    def __post_init__(self) -> None:
        rings = self.rings
        increase = len(rings) >= 2 and bool((np.diff(rings) > 0).all())
        if len(self.knots) < 3 or not increase or (rings[0], rings[-1]) != (0, 1):
            raise _error(
                "must have 3 knots or more, and rings that increase from 0 to 1"
            )
        turns_left = cross(self._spokes, np.roll(self._spokes, -1, axis=0)) > 0
        if not turns_left.all() or not (np.diff(self._angles) > 0).all():
            raise _error("must have knots counterclockwise around the centre")

    def __repr__(self) -> str:
        return (
            f"ChromaticityLattice({pluralise(len(self.knots), 'knot')}, "
            f"{pluralise(len(self.rings), 'ring')})"
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of knots and rings."""
        return len(self.knots), len(self.rings)

    @property
    def nodes(self) -> Array:
        """(K, R, 2) u′v′ of all nodes."""
        return self.white + self._spokes[:, None] * self.rings[:, None]

    @cached_property
    def _spokes(self) -> Array:
        """(K, 2) from the centre to the knots."""
        return self.knots - self.white

    @cached_property
    def _first_angle(self) -> float:
        """`_pseudo_angle` of the first knot."""
        return float(_pseudo_angle(self._spokes[0]))

    @cached_property
    def _angles(self) -> Array:
        """(K,) `_pseudo_angle` of the knots from the first one, increasing from 0."""
        return (_pseudo_angle(self._spokes) - self._first_angle) % 4.0

    @cached_property
    def _inverses(self) -> Array:
        """(K, 2, 2) from an offset to its shares of the two spokes of a sector."""
        pairs = np.stack([self._spokes, np.roll(self._spokes, -1, axis=0)], axis=2)
        return np.linalg.inv(pairs)

    def sectors(self) -> tuple[Array, Array]:
        """Return the pseudo angles (K,) of the knots, and the matrices (K, 2, 2) from
        offsets to shares of spokes.

        Angles are 0 at the first knot and increase to at most 4. Programs in other
        languages need both.
        """
        return self._angles, self._inverses

    def polar(self, offset: Array) -> tuple[Indices, Array, Array]:
        """Find the sectors (n,) of offsets (n, 2) from the centre, and in them
        positions and lengths (n,).

        Positions run from 0 at the knot of the sector to 1 at the next one. On the
        polygon the length is 1.
        """
        angles = _pseudo_angle(offset) - self._first_angle
        angles += 4.0 * (angles < 0)
        sector = np.searchsorted(self._angles, angles, side="right") - 1
        # The offset is a sum of the two spokes of its sector: their shares by Cramer's
        # rule.
        (a, b), (c, d) = self._inverses.transpose(1, 2, 0)
        u, v = offset.T
        first = np.maximum(a.take(sector) * u + b.take(sector) * v, 0.0)
        second = np.maximum(c.take(sector) * u + d.take(sector) * v, 0.0)
        length = first + second
        return sector, second / np.maximum(length, TINY), length

    def cells(self, sector: Indices, along: Array, length: Array) -> Cells:
        """Find the cells of offsets that `polar` has described."""
        length = np.minimum(length, 1.0)
        ring = np.clip(
            np.searchsorted(self.rings, length, side="right") - 1,
            0,
            len(self.rings) - 2,
        )
        across = (length - self.rings[ring]) / (self.rings[ring + 1] - self.rings[ring])
        return Cells(sector, ring, along, across)

    def corners(self, cells: Cells) -> Indices:
        """Return the numbers (n, 4) of the corners of cells, in the order of their
        weights; node (k, j) is k R + j.
        """
        knots, rings = self.shape
        first = cells.sector * rings + cells.ring
        second = first + rings
        second[cells.sector == knots - 1] -= knots * rings
        return np.stack([first, first + 1, second, second + 1], axis=1)

    def contains(self, uv: Array) -> Mask:
        """Test whether chromaticities (n, 2) are realisable; NaN is not."""
        return self.polar(uv - self.white)[2] <= 1 + LOCUS_TOLERANCE


def _error(problem: str) -> OptionError:
    return OptionError(f"a lattice over chromaticity {problem}")


def _pseudo_angle(offset: Array) -> Array:
    """Increase with the angle counterclockwise from the u′ axis, from 0 to 4, without
    transcendental functions.
    """
    u = offset[..., 0]
    v = offset[..., 1]
    slope = u / np.maximum(np.abs(u) + np.abs(v), TINY)
    return 2.0 - np.copysign(1.0 + slope, v)
