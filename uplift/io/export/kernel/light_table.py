"""The numbers that the kernel of lights reads: one array in single precision, laid out alike for all languages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.io.export.kernel.table import TEXEL, as_image
from uplift.lights.discs import MIN_RADIUS
from uplift.lights.lattice import DENOMINATOR, ChromaticityLattice
from uplift.lights.table import EmissionData

BIN_COUNT = 96
"""Bins of each axis of u′v′, from 0 to 1: most touch no lamp, or one."""

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class LightTable:
    """Numbers, and the constants with which the kernel finds them.

    Parameters
    ----------
    numbers : ndarray, shape (n,)
        Spectra of the nodes, the first knot repeated at the end, spectra of lamps, and what finds them.
    constants : mapping
        Values of the constants of `intrinsics`, but for ``WIDTH``.
    """

    numbers: Floats
    constants: dict[str, Any]

    def image(self) -> Floats:
        """Return the numbers as an image of texels, filled up with zeros.

        Returns
        -------
        ndarray, shape (rows, columns, 4)
        """
        return as_image(self.numbers)


def make_light_table(data: EmissionData) -> LightTable:
    """Lay out an emission table.

    Parameters
    ----------
    data : EmissionData
        The table.

    Returns
    -------
    LightTable
    """
    lattice, lamps = data.lattice, data.entries
    kept = lamps.radius >= MIN_RADIUS
    uv, radius = lamps.uv[kept], lamps.radius[kept]
    knots, rings = lattice.shape
    nodes = np.concatenate([data.spectra, data.spectra[:1]])
    angles, inverses = lattice.sectors()
    sections: dict[str, NDArray[Any]] = {
        "NODES": nodes,
        "LAMP_SPECTRA": lamps.spectra[kept],
        "MATRIX": _matrix(data),
        "WHITE": np.array([*lattice.white, _first_angle(lattice)]),
        "ANGLES": angles,
        "INVERSES": inverses,
        "RING_SHARES": lattice.rings,
        "LAMPS": np.column_stack([uv, radius]),
        "BINS": _bins(uv, radius),
    }
    parts, offsets, end = [], {}, 0
    for name, section in sections.items():
        offsets[name] = end
        parts.append(section.ravel())
        end += section.size
    parts.append(np.zeros(-end % TEXEL))
    at = data.wavelengths
    constants = {
        "KNOTS": knots,
        "RINGS": rings,
        "SAMPLES": len(at),
        "BIN_COUNT": BIN_COUNT,
        **{name: offset for name, offset in offsets.items() if name != "NODES"},
        "START": float(at[0]),
        "STEP": float(at[1] - at[0]),
    }
    return LightTable(np.concatenate(parts).astype(np.float32), constants)


def _matrix(data: EmissionData) -> Array:
    """Return rows from linear RGB to u′ and v′ from white times the size, the size X + 15 Y + 3 Z, and white's size."""
    white = data.lattice.white
    rows = np.array([[4, 0, 0] - white[0] * DENOMINATOR, [0, 9, 0] - white[1] * DENOMINATOR, DENOMINATOR])
    luminance = np.array([[0, 9 / white[1], 0]])
    return np.asarray(np.concatenate([rows, luminance]) @ data.rgb_to_xyz)


def _first_angle(lattice: ChromaticityLattice) -> float:
    """Return what `uplift.io.export.kernel.lights.angle` gives for the first knot."""
    u, v = lattice.knots[0] - lattice.white
    slope = u / (abs(u) + abs(v))
    return float(3 + slope if v < 0 else 1 - slope)


def _bins(uv: Array, radius: Array) -> Array:
    """Return the position of each bin's list of lamps, and the lists, each after its length."""
    low = np.clip(np.floor((uv - radius[:, None]) * BIN_COUNT), 0, BIN_COUNT - 1).astype(int)
    high = np.clip(np.floor((uv + radius[:, None]) * BIN_COUNT), 0, BIN_COUNT - 1).astype(int)
    touching: dict[tuple[int, int], list[int]] = {}
    for lamp, ((left, bottom), (right, top)) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
        for row in range(bottom, top + 1):
            for column in range(left, right + 1):
                touching.setdefault((row, column), []).append(lamp)
    places, lists = np.full((BIN_COUNT, BIN_COUNT), BIN_COUNT**2), [0]
    for (row, column), listed in touching.items():
        places[row, column] = BIN_COUNT**2 + len(lists)
        lists += [len(listed), *listed]
    return np.concatenate([places.ravel(), lists])
