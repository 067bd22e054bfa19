"""The lattice over chromaticity: rings around white that follow the spectral locus, numbered by sector and ring.

Coordinates are CIE 1976 u′v′. A knot is a point on the locus of the realisable chromaticities. Node (k, j) lies on the
segment from white to knot k, at the share of ring j. A cell lies between two neighbouring knots and two neighbouring
rings. Its two ring sides are parallel, so weights that are linear along the rings and across them give back the
chromaticity exactly. With every spectrum at its node scaled to X + 15 Y + 3 Z = 1, the denominator of u′v′, so do the
weighted spectra.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import OptionError

DENOMINATOR = np.array([1.0, 15.0, 3.0])
"""Weights of X, Y and Z in the denominator of u′ and v′."""
BEND = 3e-4
"""Share of the distance from white by which lights may lie beyond the polygon, as the spectral locus bends inward."""
TINY = float(np.finfo(np.float64).tiny)


def chromaticity(xyz: Array) -> Array:
    """Compute CIE 1976 u′v′.

    Parameters
    ----------
    xyz : ndarray, shape (..., 3)
        XYZ, not black.

    Returns
    -------
    ndarray, shape (..., 2)
        u′ = 4 X / (X + 15 Y + 3 Z) and v′ = 9 Y / (X + 15 Y + 3 Z).

    References
    ----------
    CIE 015:2018, "Colorimetry", 8.2.1.1.
    """
    return xyz[..., :2] * (4.0, 9.0) / (xyz @ DENOMINATOR)[..., None]


def unit_xyz(uv: Array) -> Array:
    """Compute XYZ of chromaticities, the inverse of `chromaticity`.

    Parameters
    ----------
    uv : ndarray, shape (..., 2)
        CIE 1976 u′v′.

    Returns
    -------
    ndarray, shape (..., 3)
        XYZ of unit X + 15 Y + 3 Z.
    """
    x, y = uv[..., 0] / 4, uv[..., 1] / 9
    return np.stack([x, y, (1 - x - 15 * y) / 3], axis=-1)


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of n colours and the weights of their corners.

    Parameters
    ----------
    sector, ring : ndarray of int, shape (n,)
        Knot and ring of the lowest corner.
    along, across : ndarray, shape (n,)
        Position in the cell from 0 to 1: towards the next knot, and towards the next ring.
    """

    sector: Indices
    ring: Indices
    along: Array
    across: Array

    @property
    def weights(self) -> Array:
        """(n, 4) weights of the corners; they sum to 1."""
        t, s = self.along, self.across
        return np.stack([(1 - t) * (1 - s), (1 - t) * s, t * (1 - s), t * s], axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class ChromaticityLattice:
    """Nodes over all chromaticities of lights.

    Parameters
    ----------
    white : ndarray, shape (2,)
        u′v′ of the centre.
    knots : ndarray, shape (K, 2)
        u′v′ of the knots, counterclockwise, the corners of a polygon that the centre views whole.
    rings : ndarray, shape (R,)
        Shares of the way from the centre to the polygon, from 0 to 1, increasing.

    Raises
    ------
    OptionError
        Rings that do not increase from 0 to 1, or knots that do not surround the centre
        (``invalid-chromaticity-lattice``).
    """

    white: Array
    knots: Array
    rings: Array

    def __post_init__(self) -> None:
        shapes = self.white.shape == (2,) and self.knots.shape == (len(self.knots), 2) and self.rings.ndim == 1
        if not shapes or len(self.knots) < 3 or len(self.rings) < 2:
            raise _error(f"must have 3 knots and 2 rings or more, got {self.knots.shape}, {self.rings.shape}")
        if not (self.rings[0] == 0 and self.rings[-1] == 1 and (np.diff(self.rings) > 0).all()):
            raise _error("must have rings that increase from 0 to 1")
        following = np.roll(self._spokes, -1, axis=0)
        if not (_cross(self._spokes, following) > 0).all() or not (np.diff(self._angles) > 0).all():
            raise _error("must have knots counterclockwise around the centre")

    def __repr__(self) -> str:
        return f"ChromaticityLattice({len(self.knots)} knots, {len(self.rings)} rings)"

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of knots and rings."""
        return len(self.knots), len(self.rings)

    @property
    def nodes(self) -> Array:
        """(K, R, 2) u′v′ of all nodes."""
        return np.asarray(self.white + self._spokes[:, None] * self.rings[:, None])

    @cached_property
    def _spokes(self) -> Array:
        """(K, 2) from the centre to the knots."""
        return np.asarray(self.knots - self.white)

    @cached_property
    def _angles(self) -> Array:
        """(K,) `_pseudo_angle` of the knots from the first one, increasing from 0."""
        return np.asarray((_pseudo_angle(self._spokes) - self._first_angle) % 4.0)

    @cached_property
    def _first_angle(self) -> float:
        """`_pseudo_angle` of the first knot."""
        return float(_pseudo_angle(self._spokes[0]))

    @cached_property
    def _inverses(self) -> Array:
        """(K, 2, 2) from an offset to its shares of the two spokes of a sector."""
        pairs = np.stack([self._spokes, np.roll(self._spokes, -1, axis=0)], axis=2)
        return np.asarray(np.linalg.inv(pairs))

    def sectors(self) -> tuple[Array, Array]:
        """Return what finds the sector of an offset from the centre, for programs in other languages.

        Returns
        -------
        angles : ndarray, shape (K,)
            Pseudo angles of the knots, from 0 at the first one, increasing to at most 4.
        inverses : ndarray, shape (K, 2, 2)
            Matrices from an offset to its shares of the spokes of the knot and the next one.
        """
        return self._angles, self._inverses

    def polar(self, offset: Array) -> tuple[Indices, Array, Array]:
        """Find the sectors of offsets from the centre.

        Parameters
        ----------
        offset : ndarray, shape (n, 2)
            u′v′ minus that of the centre, or any multiple of it.

        Returns
        -------
        sector : ndarray of int, shape (n,)
            Number of the first of two knots.
        along : ndarray, shape (n,)
            Position from 0 to 1 between them.
        share : ndarray, shape (n,)
            Length of the offset, where the polygon has 1.
        """
        angles = _pseudo_angle(offset) - self._first_angle
        angles += 4.0 * (angles < 0)
        sector = np.searchsorted(self._angles, angles, side="right") - 1
        (a, b), (c, d) = self._inverses.transpose(1, 2, 0)
        u, v = offset.T
        first = np.maximum(a.take(sector) * u + b.take(sector) * v, 0.0)
        second = np.maximum(c.take(sector) * u + d.take(sector) * v, 0.0)
        share = first + second
        return sector, second / np.maximum(share, TINY), share

    def locate(self, uv: Array) -> Cells:
        """Find the cells of chromaticities, of which those outside are moved to the polygon.

        Parameters
        ----------
        uv : ndarray, shape (n, 2)
            u′v′.

        Returns
        -------
        Cells
        """
        return self.cells(*self.polar(uv - self.white))

    def cells(self, sector: Indices, along: Array, share: Array) -> Cells:
        """Find the cells of chromaticities whose sectors are known.

        Parameters
        ----------
        sector, along, share : ndarray, shape (n,)
            What `polar` returns.

        Returns
        -------
        Cells
        """
        share = np.minimum(share, 1.0)
        ring = np.clip(np.searchsorted(self.rings, share, side="right") - 1, 0, len(self.rings) - 2)
        across = (share - self.rings[ring]) / (self.rings[ring + 1] - self.rings[ring])
        return Cells(sector, ring, along, across)

    def corners(self, cells: Cells) -> Indices:
        """Return the numbers of the corners of cells, in the order of their weights.

        Parameters
        ----------
        cells : Cells
            Cells of n colours.

        Returns
        -------
        ndarray of int, shape (n, 4)
            Numbers of nodes; node (k, j) has the number k R + j.
        """
        knots, rings = self.shape
        first = cells.sector * rings + cells.ring
        second = first + rings
        second[cells.sector == knots - 1] -= knots * rings
        return np.stack([first, first + 1, second, second + 1], axis=1)

    def contains(self, uv: Array) -> Mask:
        """Test whether chromaticities are realisable.

        Parameters
        ----------
        uv : ndarray, shape (n, 2)
            u′v′.

        Returns
        -------
        ndarray of bool, shape (n,)
            False for NaN.
        """
        return np.asarray(self.polar(uv - self.white)[2] <= 1 + BEND)


def _error(problem: str) -> OptionError:
    return OptionError(f"a lattice over chromaticity {problem}", code="invalid-chromaticity-lattice")


def _cross(first: Array, second: Array) -> Array:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])


def _pseudo_angle(offset: Array) -> Array:
    """Increase with the angle counterclockwise from the u′ axis, from 0 to 4, without transcendental functions."""
    u, v = offset[..., 0], offset[..., 1]
    slope = u / np.maximum(np.abs(u) + np.abs(v), TINY)
    return np.asarray(2.0 - np.copysign(1.0 + slope, v))
