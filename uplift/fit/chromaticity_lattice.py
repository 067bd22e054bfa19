"""The lattice over the chromaticities of an observer, and the spectra of its rim: mixtures of two wavelengths."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.lattice.chromaticity import DENOMINATOR, ChromaticityLattice, chromaticity


def locus_lattice(
    radiometry: Array, white: Array, knots: int, rings: Array
) -> tuple[ChromaticityLattice, Array]:
    """Create a lattice whose rim is the polygon of the chromaticities of single wavelengths.

    Every corner of the polygon is a knot; the others divide its longest edges, as white views them.

    Parameters
    ----------
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    white : ndarray, shape (2,)
        u′v′ of the centre.
    knots : int
        Smallest number of knots.
    rings : ndarray, shape (R,)
        Shares from 0 to 1.

    Returns
    -------
    lattice : ChromaticityLattice
        With ``knots`` knots, or as many as the polygon has corners.
    rim : ndarray, shape (K, N)
        Power of unit X + 15 Y + 3 Z at the knots.
    """
    from scipy.spatial import ConvexHull

    size = radiometry @ DENOMINATOR
    visible = np.flatnonzero(size > 0)
    uv = chromaticity(radiometry[visible])
    corners = ConvexHull(uv).vertices
    single = np.zeros((len(corners), len(radiometry)))
    single[np.arange(len(corners)), visible[corners]] = 1 / size[visible[corners]]
    places, rim = _subdivide(uv[corners], single, white, knots)
    return ChromaticityLattice(white, places, rings), rim


def _subdivide(places: Array, spectra: Array, white: Array, count: int) -> tuple[Array, Array]:
    """Halve the edge of the largest angle until there are ``count`` corners."""
    while len(places) < count:
        following = np.roll(places, -1, axis=0)
        edge = int(np.argmax(_angles(places - white, following - white)))
        places, spectra = (
            np.insert(array, edge + 1, (array[edge] + array[(edge + 1) % len(array)]) / 2, axis=0)
            for array in (places, spectra)
        )
    return places, spectra


def _angles(first: Array, second: Array) -> Array:
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return np.asarray(np.arctan2(cross, (first * second).sum(axis=1)))
