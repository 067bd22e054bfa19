"""What all nodes carry, worked out beforehand: for questions longer than the lattice has points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike

from uplift.common.arrays import Array, Values
from uplift.cube import CubeData
from uplift.lookup.blocks import blockwise
from uplift.lookup.nodes import around
from uplift.models import reflectance


@dataclass(frozen=True, eq=False)
class NodeTable:
    """Numbers (dim³, K) of the lattice points, NaN where absent, and (E, K) of the atlas entries; float64 or 32."""

    data: CubeData
    lattice: Values
    atlas: Values

    @classmethod
    def of_points(cls, data: CubeData, points: Values, atlas: Values) -> NodeTable:
        """From numbers (m, K) of the points that are present."""
        if data.complete_cells is None:
            return cls(data, points, atlas)
        lattice = np.full((data.lattice.size, points.shape[1]), np.nan, points.dtype)
        lattice[data.points.present] = points
        return cls(data, lattice, atlas)

    def spectra(self, rgb: Array) -> Values:
        """Reflectance (n, N) in [0, 1] at linear RGB (n, 3), in mode ``spectra``."""
        return np.clip(around(self.data, rgb).weighted_sum(self.lattice, self.atlas), 0, 1)

    def nearest(self, rgb: Array) -> Values:
        """The same in mode ``nearest``."""
        return around(self.data, rgb).nearest(self.lattice, self.atlas)


def tabulate(
    data: CubeData, wavelengths: Array, dtype: DTypeLike = np.float64, threads: int = 1
) -> NodeTable:
    """Reflectances of all nodes at wavelengths (N,) nm; takes dim³ × N numbers."""

    def spectra(coefficients: Array) -> Values:
        return blockwise(
            lambda rows: reflectance(data.model, rows, wavelengths),
            coefficients,
            len(wavelengths),
            dtype,
            threads,
        )

    return NodeTable.of_points(
        data, spectra(data.points.coefficients[data.points.present]), spectra(data.atlas.coefficients)
    )


TABULATED = {"spectra": NodeTable.spectra, "nearest": NodeTable.nearest}
"""Modes that a table serves."""
