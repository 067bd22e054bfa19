"""Lamps that an emission table returns exactly, each in a disc around its chromaticity."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.lights import Lamps
from uplift.common.arrays import Array
from uplift.lights.discs import MIN_RADIUS, LampEntries
from uplift.lights.lattice import DENOMINATOR, ChromaticityLattice, chromaticity

MAX_RADIUS = 0.01
"""Largest radius of a disc in u′v′."""
SAME_CHROMATICITY = 1e-5
"""Distance in u′v′ at which two constraints are one: they have one RGB."""
CLEARANCE = 2e-3
"""Distance in u′v′ that other lamps keep from constraints: about two just noticeable differences."""


def lamp_entries(
    constraints: Lamps, others: Lamps, lattice: ChromaticityLattice, radiometry: Array
) -> tuple[LampEntries, tuple[tuple[str, str], ...]]:
    """Give each lamp a disc that reaches half of the way to the next one, and does not leave the lattice.

    Parameters
    ----------
    constraints : Lamps
        Lamps that must be exact.
    others : Lamps
        Lamps that are exact unless they are close to a constraint, or have nearly the chromaticity of another lamp:
        of two lamps of one RGB neither is exact, and the expected light averages them.
    lattice : ChromaticityLattice
        Lattice of the table.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.

    Returns
    -------
    entries : LampEntries
        The lamps.
    duplicates : tuple of (str, str)
        Constraints that are left out, each with an earlier one of the same chromaticity.
    """
    power, uv = _unit(constraints.power, radiometry)
    kept, duplicates = _distinct(constraints.names, uv)
    more, more_uv = _unit(others.power, radiometry)
    clear = np.flatnonzero(_distances(more_uv, uv[kept]).min(axis=1, initial=np.inf) > CLEARANCE)
    names = (*(constraints.names[row] for row in kept), *(others.names[row] for row in clear))
    uv = np.concatenate([uv[kept], more_uv[clear]])
    apart = _distances(uv, uv) + np.diag(np.full(len(uv), np.inf))
    radius = np.minimum(apart.min(axis=1) / 2, MAX_RADIUS)
    radius = np.minimum(radius, _to_rim(uv, lattice))
    spectra = np.concatenate([power[kept], more[clear]])
    resolved = np.flatnonzero((np.arange(len(names)) < len(kept)) | (radius >= MIN_RADIUS))
    entries = LampEntries(tuple(names[row] for row in resolved), uv[resolved], spectra[resolved], radius[resolved])
    return entries, duplicates


def _unit(power: Array, radiometry: Array) -> tuple[Array, Array]:
    """Power of unit X + 15 Y + 3 Z, and u′v′."""
    unit = power / (power @ radiometry @ DENOMINATOR)[:, None]
    return unit, chromaticity(unit @ radiometry)


def _distinct(names: tuple[str, ...], uv: Array) -> tuple[list[int], tuple[tuple[str, str], ...]]:
    """Numbers of the lamps without those of the chromaticity of an earlier one, and the names of both."""
    kept: list[int] = []
    duplicates: list[tuple[str, str]] = []
    for row, name in enumerate(names):
        near = np.flatnonzero(_distances(uv[row : row + 1], uv[kept])[0] <= SAME_CHROMATICITY)
        if near.size:
            duplicates.append((name, names[kept[near[0]]]))
        else:
            kept.append(row)
    return kept, tuple(duplicates)


def _distances(first: Array, second: Array) -> Array:
    return np.asarray(np.linalg.norm(first[:, None] - second, axis=-1))


def _to_rim(uv: Array, lattice: ChromaticityLattice) -> Array:
    """Distances (n,) from the polygon; 0 on it."""
    edges = np.roll(lattice.knots, -1, axis=0) - lattice.knots
    offset = uv[:, None] - lattice.knots
    across = edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0]
    return np.asarray((across / np.linalg.norm(edges, axis=1)).min(axis=1).clip(0.0))
