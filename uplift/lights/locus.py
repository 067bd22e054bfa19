"""The lattice over the chromaticities of an observer, and the spectra of its rim: mixtures of two wavelengths."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.lights.lattice import BEND, DENOMINATOR, ChromaticityLattice, chromaticity

MIN_ANGLE = 1e-3
"""Smallest angle in radians between a wavelength inside the convex polygon and its neighbours on the rim."""


def locus_lattice(radiometry: Array, white: Array, knots: int, rings: Array) -> tuple[ChromaticityLattice, Array]:
    """Create a lattice whose rim is the spectral locus: the polygon of the chromaticities of single wavelengths.

    Every corner of the polygon is a knot; the others divide its longest edges, as white views them. The locus is not
    quite convex: from 575 to 700 nm, mixtures of wavelengths lie outside it by up to `BEND`. They have a place on the
    rim nevertheless, next to the wavelengths between them. On the convex polygon, pure orange would be a mixture of
    yellow and red.

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
    size = radiometry @ DENOMINATOR
    visible = np.flatnonzero(size > 0)
    uv = chromaticity(radiometry[visible])
    corners = _corners(uv, white)
    single = np.zeros((len(corners), len(radiometry)))
    single[np.arange(len(corners)), visible[corners]] = 1 / size[visible[corners]]
    places, rim = _subdivide(uv[corners], single, white, knots)
    return ChromaticityLattice(white, places, rings), rim


def _corners(uv: Array, white: Array) -> Indices:
    """Corners of the convex polygon of chromaticities (n, 2), and others that lie on it but for `BEND`, in order."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(uv).vertices
    _, _, share = ChromaticityLattice(white, uv[hull], np.array([0.0, 1.0])).polar(uv - white)
    corners = list(hull)
    for row in np.flatnonzero(share >= 1 - BEND):
        apart = np.abs(_angles(uv[corners] - white, np.broadcast_to(uv[row] - white, (len(corners), 2))))
        if apart.min() >= MIN_ANGLE:
            corners.append(row)
    turn = _angles(np.broadcast_to(uv[hull[0]] - white, (len(corners), 2)), uv[corners] - white) % (2 * np.pi)
    return np.array(corners)[np.argsort(turn)]


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
