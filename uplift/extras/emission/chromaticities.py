"""Chromaticities of lights in the lattice of a table, and the power there. Needs numpy
only.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import ColourError
from uplift.extras.emission.file import EmissionData
from uplift.extras.emission.lattice import DENOMINATOR, LOCUS_TOLERANCE, Cells
from uplift.lattice.lattice import weighted_sum

FAR = 10.0
"""Bound of u′v′ of colours that no light has; those of lights are within 0 and 1."""


def power_of_xyz(
    data: EmissionData, nodes: Values, entries: Values, xyz: Array, *, clip: bool
) -> NDArray[Any]:
    """Power (n, N) of lights of XYZ (n, 3), in the type of the spectra of the nodes (K
    · R, N) and lamps (E, N).
    """
    uv, size = chromaticities(xyz)
    discs = data.entries.locate(uv)
    uv[discs.rows] = discs.exit_uv
    cells, size = find_cells(data, xyz, uv, size, clip=clip)
    entry_size = size[discs.rows] * discs.share
    size[discs.rows] -= entry_size
    power = weighted_sum(
        nodes, data.lattice.corners(cells), cells.weights * size[:, None]
    )
    power[discs.rows] += entry_size[:, None].astype(power.dtype) * entries[discs.entry]
    return power


def chromaticities(xyz: Array) -> tuple[Array, Array]:
    """u′v′ (n, 2), column by column, and X + 15 Y + 3 Z (n,); any u′v′ within `FAR`
    where that is not positive.
    """
    x, y, z = np.ascontiguousarray(xyz.T)
    size = x + 15.0 * y + 3.0 * z
    known = np.where(size > 0, size, np.inf)
    uv = np.empty((2, len(xyz)))
    with np.errstate(over="ignore"):
        np.divide(4.0 * x, known, out=uv[0])
        np.divide(9.0 * y, known, out=uv[1])
    return np.clip(uv, -FAR, FAR, out=uv).T, size


def find_cells(
    data: EmissionData, xyz: Array, uv: Array, size: Array, *, clip: bool
) -> tuple[Cells, Array]:
    """Cells of chromaticities (n, 2), and X + 15 Y + 3 Z (n,); those that no light has
    are clipped or an error.
    """
    lattice = data.lattice
    sector, along, length = lattice.polar(uv - lattice.white)
    rows = np.flatnonzero((size <= 0) | (length > 1))
    if rows.size:
        moved, size[rows] = _to_locus(data, xyz[rows], clip=clip)
        sector[rows], along[rows], length[rows] = lattice.polar(moved - lattice.white)
    return lattice.cells(sector, along, length), size


def polar_coordinates(data: EmissionData, xyz: Array) -> tuple[Array, Array, Array]:
    """u′v′ from white (n, 2), X + 15 Y + 3 Z (n,), and the length (n,) of
    `ChromaticityLattice.polar`.

    All are homogeneous in XYZ: u′v′ and lengths are multiplied by X + 15 Y + 3 Z, which
    may be 0.
    """
    size = xyz @ DENOMINATOR
    offset = xyz[:, :2] * (4.0, 9.0) - size[:, None] * data.lattice.white
    return offset, size, data.lattice.polar(offset)[2]


def is_light(xyz: Array, size: Array, length: Array) -> Mask:
    """Test whether XYZ (n, 3) are black or within the spectral locus, beyond which
    `LOCUS_TOLERANCE` is allowed.
    """
    return ((size > 0) & (length <= size * (1 + LOCUS_TOLERANCE))) | (xyz == 0).all(
        axis=1
    )


def _to_locus(data: EmissionData, xyz: Array, *, clip: bool) -> tuple[Array, Array]:
    """Move XYZ (n, 3) towards white of the same luminance, white + f (colour − white),
    up to the spectral locus.

    Returns u′v′ (n, 2) and X + 15 Y + 3 Z (n,). Unless ``clip``, `ColourError` for
    excesses beyond `LOCUS_TOLERANCE`.
    """
    offset, size, length = polar_coordinates(data, xyz)
    wrong = ~is_light(xyz, size, length)
    if not clip and wrong.any():
        first = ", ".join(f"{value:.4g}" for value in xyz[wrong][0])
        raise ColourError(
            f"no light has the colour XYZ ({first})",
            code="colour-not-a-light",
            hint="use outside='clip' for the nearest colour towards white",
        )
    white = np.maximum(xyz[:, 1], 0.0) * 9 / data.lattice.white[1]
    reach = length + white - size
    step = np.divide(white, reach, out=np.zeros_like(reach), where=reach > 0)
    rim = np.divide(
        offset, length[:, None], out=np.zeros_like(offset), where=length[:, None] > 0
    )
    return data.lattice.white + rim, step * length
