"""Tables of the values of all nodes, for queries of more colours than the lattice has points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike

from uplift.common.arrays import Array, Values
from uplift.cube import CubeData
from uplift.lookup.blocks import blockwise
from uplift.lookup.nodes import around
from uplift.models import reflectance


@dataclass(frozen=True, eq=False, repr=False)
class NodeTable:
    """Values of all nodes, float64 or float32.

    Parameters
    ----------
    data : CubeData
        The cube.
    lattice : ndarray, shape (dim³, K)
        Values of the lattice points, NaN at absent points.
    atlas : ndarray, shape (E, K)
        Values of the atlas entries.
    """

    data: CubeData
    lattice: Values
    atlas: Values

    @classmethod
    def of_present_points(cls, data: CubeData, points: Values, atlas: Values) -> NodeTable:
        """Make a table from values (m, K) of the present points."""
        if data.complete_cells is None:
            return cls(data, points, atlas)
        lattice = np.full((data.lattice.size, points.shape[1]), np.nan, points.dtype)
        lattice[data.points.present] = points
        return cls(data, lattice, atlas)

    def spectra(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``spectra``."""
        return np.clip(around(self.data, rgb).weighted_sum(self.lattice, self.atlas), 0, 1)

    def nearest(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``nearest``."""
        return around(self.data, rgb).nearest(self.lattice, self.atlas)


def tabulate(
    data: CubeData, wavelengths: Array, dtype: DTypeLike = np.float64, threads: int = 1
) -> NodeTable:
    """Compute the reflectances of all nodes at wavelengths (N,) in nm: dim³ × N numbers."""

    def spectra(coefficients: Array) -> Values:
        return blockwise(
            lambda rows: reflectance(data.model, rows, wavelengths),
            coefficients,
            len(wavelengths),
            dtype,
            threads,
        )

    present = data.points.coefficients[data.points.present]
    return NodeTable.of_present_points(data, spectra(present), spectra(data.atlas.coefficients))


TABULATED = {"spectra": NodeTable.spectra, "nearest": NodeTable.nearest}
"""Modes that can use a table."""
