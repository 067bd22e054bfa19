"""Tables of the values of all nodes, for queries of more colours than the lattice has points."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import DTypeLike

from uplift.common.arrays import Array, Values
from uplift.cube import CubeData
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import around, extend_coefficients, inexact_rows, spectra
from uplift.models import reflectance


@dataclass(frozen=True, eq=False, repr=False)
class NodeTable:
    """Values of all nodes, float64 or float32."""

    data: CubeData
    lattice: Values
    """(dim³, K) values of the lattice points, NaN at absent points."""
    atlas: Values
    """(E, K) values of the atlas entries."""
    wavelengths: Array | None = None
    """(K,) wavelengths in nm of a table of reflectances; None for other values."""

    @classmethod
    def of_present_points(
        cls, data: CubeData, points: Values, atlas: Values, wavelengths: Array | None = None
    ) -> "NodeTable":
        """Make a table from values (m, K) of the present points."""
        if data.complete_cells is None:
            return cls(data, points, atlas, wavelengths)
        lattice = np.full((data.lattice.size, points.shape[1]), np.nan, points.dtype)
        lattice[data.points.present] = points
        return cls(data, lattice, atlas, wavelengths)

    def spectra(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``spectra``."""
        mixed = np.clip(self.values(rgb), 0, 1)
        rows = inexact_rows(self.data, rgb)
        if rows.size and self.wavelengths is not None:
            mixed[rows] = spectra(self.data, rgb[rows], self.wavelengths)
        return mixed

    def nearest(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``nearest``."""
        points, rows, entry = around(self.data, rgb).nearest()
        values = self.lattice[points]
        values[rows] = self.atlas[entry]
        return values

    def values(self, rgb: Array) -> Values:
        """Weighted values (n, K) of the nodes."""
        return around(self.data, rgb).weighted_sum(self.lattice, self.atlas)


def tabulate(data: CubeData, wavelengths: Array, dtype: DTypeLike = np.float64, threads: int = 1) -> NodeTable:
    """Compute the reflectances of all nodes at wavelengths (N,) in nm: dim³ × N numbers."""
    evaluate_rows = partial(reflectance, data.model, wavelengths=wavelengths)
    stored = data.points.coefficients[data.points.present]
    present = blockwise(evaluate_rows, stored, len(wavelengths), dtype, threads)
    entries = data.entry_spectra.reflectance(np.arange(len(data.atlas.names)), wavelengths)
    return NodeTable.of_present_points(data, present, entries.astype(dtype, copy=False), wavelengths)


def tabulate_coefficients(data: CubeData, count: int, dtype: DTypeLike = np.float64, threads: int = 1) -> NodeTable:
    """Tabulate the coefficients of all nodes, ``count`` each: as many as the nodes or the entries have."""
    present = data.points.coefficients[data.points.present]
    entries = data.atlas.coefficients
    if count != data.model.count:
        present = blockwise(partial(extend_coefficients, data), present, count, dtype, threads)
        entries = data.entry_spectra.coefficients
    return NodeTable.of_present_points(data, present.astype(dtype, copy=False), entries.astype(dtype, copy=False))
