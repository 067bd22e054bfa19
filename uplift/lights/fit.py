"""Fit the nodes of an emission table: the light expected at each chromaticity, moved least to it exactly."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.solve import solve
from uplift.lights.lattice import DENOMINATOR, ChromaticityLattice, chromaticity, unit_xyz
from uplift.models.exponential import Exponential
from uplift.models.minimum_norm import forward_map

TOLERANCE = 1e-9
"""Distance in XYZ, of unit X + 15 Y + 3 Z, at which a node is solved."""
MAX_PASSES = 60
FAINTEST = 1e-6
"""Smallest power of a prior as a share of its mean: the model has positive powers only."""


def nearest_lights(prior: Array, uv: Array, radiometry: Array) -> Array:
    """Move spectra to chromaticities, each by the smoothest and smallest factor.

    Parameters
    ----------
    prior : ndarray, shape (n, N)
        Expected power, of any scale.
    uv : ndarray, shape (n, 2)
        u′v′ within the spectral locus.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ, at evenly spaced wavelengths.

    Returns
    -------
    ndarray, shape (n, N)
        Power of unit X + 15 Y + 3 Z. Chromaticities near the spectral locus may be missed; see `mix_with_rim`.
    """
    model = Exponential(len(radiometry), 0.0, 1.0)
    wavelengths = np.linspace(0.0, 1.0, len(radiometry))
    basis = model.basis(wavelengths)
    positive = np.maximum(prior, FAINTEST * prior.mean(axis=1, keepdims=True))
    positive = positive / (positive @ radiometry @ DENOMINATOR)[:, None]
    multipliers = np.asarray(np.linalg.solve(basis, model.unsquash(positive).T).T, dtype=float)
    found = solve(
        model,
        forward_map(model, wavelengths, radiometry.T),
        multipliers,
        unit_xyz(uv),
        tolerance=TOLERANCE,
        max_passes=MAX_PASSES,
        prior=multipliers,
    )
    power = np.exp(found.multipliers @ basis.T)
    return np.asarray(power / (power @ radiometry @ DENOMINATOR)[:, None])


def mix_with_rim(power: Array, uv: Array, lattice: ChromaticityLattice, rim: Array, radiometry: Array) -> Array:
    """Remove the last differences in chromaticity by adding a little light of the rim.

    Parameters
    ----------
    power : ndarray, shape (n, N)
        Power of unit X + 15 Y + 3 Z.
    uv : ndarray, shape (n, 2)
        u′v′ that the spectra must have.
    lattice : ChromaticityLattice
        Lattice of K knots.
    rim : ndarray, shape (K, N)
        Power of unit X + 15 Y + 3 Z at the knots.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.

    Returns
    -------
    ndarray, shape (n, N)
        Power of unit X + 15 Y + 3 Z, with the chromaticities ``uv`` up to rounding.
    """
    reached = chromaticity(power @ radiometry)
    share, sector, along = _exits(reached, uv, lattice)
    following = (sector + 1) % len(rim)
    edge = (1 - along)[:, None] * rim[sector] + along[:, None] * rim[following]
    return np.asarray((1 - share)[:, None] * power + share[:, None] * edge)


def _exits(start: Array, goal: Array, lattice: ChromaticityLattice) -> tuple[Array, Array, Array]:
    """Where rays from ``start`` through ``goal`` (n, 2) leave the polygon.

    Returns the share of that point in the mixture with ``start`` that gives the goal, its sector, and its position.
    """
    knots = lattice.knots
    edges = np.roll(knots, -1, axis=0) - knots
    direction = goal - start
    denominator = direction[:, None, 0] * edges[:, 1] - direction[:, None, 1] * edges[:, 0]
    offset = knots - start[:, None]
    valid = np.abs(denominator) > 0
    safe = np.where(valid, denominator, 1.0)
    length = (offset[..., 0] * edges[:, 1] - offset[..., 1] * edges[:, 0]) / safe
    along = (offset[..., 0] * direction[:, None, 1] - offset[..., 1] * direction[:, None, 0]) / safe
    inside = valid & (length > 0) & (along >= -1e-9) & (along <= 1 + 1e-9)
    length = np.where(inside, length, np.inf)
    sector = length.argmin(axis=1)
    rows = np.arange(len(start))
    share = 1 / np.maximum(length[rows, sector], 1.0)
    return share, sector, np.clip(along[rows, sector], 0.0, 1.0)
