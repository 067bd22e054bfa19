"""From XYZ of lights to their power: nodes and lamps around a chromaticity, and weighted sums. Needs numpy only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import ColourError
from uplift.lattice import weighted_sum
from uplift.lights.lattice import BEND, DENOMINATOR, Cells
from uplift.lights.table import EmissionData


@dataclass(frozen=True, eq=False)
class Samples:
    """Spectra of an emission table at the wavelengths of a query.

    Parameters
    ----------
    nodes : ndarray, shape (K · R, N)
        Power at the nodes, float64 or float32.
    entries : ndarray, shape (E, N)
        Power of the lamps, in the same type.
    """

    nodes: Values
    entries: Values


def resample(data: EmissionData, wavelengths: Array, kind: DTypeLike) -> Samples:
    """Interpolate all spectra linearly, with constant extrapolation.

    Parameters
    ----------
    data : EmissionData
        The table.
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm.
    kind : dtype
        Type of the result.

    Returns
    -------
    Samples
    """
    grid = data.wavelengths
    nodes, entries = data.spectra.reshape(-1, len(grid)), data.entries.spectra
    if not np.array_equal(wavelengths, grid):
        place = np.clip(np.interp(wavelengths, grid, np.arange(len(grid))), 0, len(grid) - 1)
        low = np.minimum(place.astype(int), len(grid) - 2)
        share = place - low
        nodes, entries = (spectra[:, low] * (1 - share) + spectra[:, low + 1] * share for spectra in (nodes, entries))
    return Samples(nodes.astype(kind, copy=False), entries.astype(kind, copy=False))


Treatment = Callable[[EmissionData, Array], tuple[Array, Array]]
"""What is done with XYZ (m, 3) that no light has: return their u′v′ (m, 2) and X + 15 Y + 3 Z (m,)."""

FAR = 10.0
"""Bound of u′v′ of colours that no light has; those of lights are within 0 and 1."""


def spectra(data: EmissionData, samples: Samples, treat: Treatment, xyz: Array) -> NDArray[Any]:
    """Compute the power of lights.

    Parameters
    ----------
    data : EmissionData
        The table.
    samples : Samples
        Its spectra at N wavelengths.
    treat : callable
        One of `TREATMENTS`.
    xyz : ndarray, shape (n, 3)
        XYZ.

    Returns
    -------
    ndarray, shape (n, N)
        Power, in the type of the samples.

    Raises
    ------
    ColourError
        A colour that no light has (``colour-not-a-light``), and the treatment is an error.
    """
    uv, size = _chromaticities(data, xyz)
    discs = data.entries.locate(uv)
    uv[discs.rows] = discs.exit_uv
    cells, size = _cells(data, treat, xyz, uv, size)
    entry_size = size[discs.rows] * discs.share
    size[discs.rows] -= entry_size
    power = weighted_sum(samples.nodes, data.lattice.corners(cells), cells.weights * size[:, None])
    power[discs.rows] += entry_size[:, None].astype(power.dtype) * samples.entries[discs.entry]
    return power


def errors(data: EmissionData, xyz: Array) -> NDArray[Any]:
    """Interpolate the expected errors (n, 1) of lights of XYZ (n, 3). Raise `ColourError` as `spectra` does."""
    uv, size = _chromaticities(data, xyz)
    cells, _ = _cells(data, refuse, xyz, uv, size)
    return np.asarray(weighted_sum(data.error.reshape(-1, 1).astype(float), data.lattice.corners(cells), cells.weights))


def is_light(data: EmissionData, xyz: Array) -> Mask:
    """Test whether XYZ (n, 3) are black or within the spectral locus, beyond which `BEND` is allowed.

    Parameters
    ----------
    data : EmissionData
        The table.
    xyz : ndarray, shape (n, 3)
        XYZ.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    offset, size = _homogeneous(data, xyz)
    _, _, share = data.lattice.polar(offset)
    return np.asarray(((size > 0) & (share <= size * (1 + BEND))) | (xyz == 0).all(axis=1))


def refuse(data: EmissionData, xyz: Array) -> tuple[Array, Array]:
    """Raise `ColourError` unless all excesses are within `BEND`, which `clip` removes."""
    wrong = ~is_light(data, xyz)
    if wrong.any():
        first = ", ".join(f"{value:.4g}" for value in xyz[wrong][0])
        raise ColourError(
            f"no light has the colour XYZ ({first})",
            code="colour-not-a-light",
            hint="use outside='clip' for the nearest colour towards white",
        )
    return clip(data, xyz)


def clip(data: EmissionData, xyz: Array) -> tuple[Array, Array]:
    """Move colours towards white of the same luminance, white + f (colour − white), up to the spectral locus."""
    offset, size = _homogeneous(data, xyz)
    _, _, share = data.lattice.polar(offset)
    white = np.maximum(xyz[:, 1], 0.0) * 9 / data.lattice.white[1]
    reach = share + white - size
    step = np.divide(white, reach, out=np.zeros_like(reach), where=reach > 0)
    rim = np.divide(offset, share[:, None], out=np.zeros_like(offset), where=share[:, None] > 0)
    return data.lattice.white + rim, step * share


TREATMENTS: dict[str, Treatment] = {"error": refuse, "clip": clip}
"""Treatments of colours that no light has, by name: an error, or the nearest colour towards white."""


def _homogeneous(data: EmissionData, xyz: Array) -> tuple[Array, Array]:
    """u′v′ from white (n, 2), times X + 15 Y + 3 Z, and X + 15 Y + 3 Z (n,)."""
    size = xyz @ DENOMINATOR
    return xyz[:, :2] * (4.0, 9.0) - size[:, None] * data.lattice.white, size


def _chromaticities(data: EmissionData, xyz: Array) -> tuple[Array, Array]:
    """u′v′ (n, 2), column by column, and X + 15 Y + 3 Z (n,); any u′v′ within `FAR` where that is not positive."""
    x, y, z = np.ascontiguousarray(xyz.T)
    size = x + 15.0 * y + 3.0 * z
    known = np.where(size > 0, size, np.inf)
    uv = np.empty((2, len(xyz)))
    with np.errstate(over="ignore"):
        np.divide(4.0 * x, known, out=uv[0])
        np.divide(9.0 * y, known, out=uv[1])
    return np.clip(uv, -FAR, FAR, out=uv).T, size


def _cells(data: EmissionData, treat: Treatment, xyz: Array, uv: Array, size: Array) -> tuple[Cells, Array]:
    """Cells of chromaticities (n, 2), and X + 15 Y + 3 Z (n,), after the treatment of those that no light has."""
    lattice = data.lattice
    sector, along, share = lattice.polar(uv - lattice.white)
    rows = np.flatnonzero((size <= 0) | (share > 1))
    if rows.size:
        moved, size[rows] = treat(data, xyz[rows])
        sector[rows], along[rows], share[rows] = lattice.polar(moved - lattice.white)
    return lattice.cells(sector, along, share), size
