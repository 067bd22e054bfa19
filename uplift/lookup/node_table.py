"""Tables of the values of all nodes, for queries of more colours than the lattice has points."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from uplift.colorimetry.sensor import as_rgb
from uplift.common.arrays import Array, Indices, Values
from uplift.cube import CubeData
from uplift.lookup.blocks import as_colours, blockwise
from uplift.lookup.interpolate import (
    around,
    coefficients,
    extend_coefficients,
    extended_coefficients,
    fading_rows,
    inexact_rows,
    spectra,
)
from uplift.models import reflectance

Exact = Callable[[Array], tuple[Indices, Array]]
"""From linear RGB (n, 3) to the rows (m,) that are moved as nodes have not their own colours, and values (m, K)."""


@dataclass(frozen=True, eq=False, repr=False)
class NodeTable:
    """Values of all nodes, float64 or float32."""

    data: CubeData
    lattice: Values
    """(dim³, K) values of the lattice points, NaN at absent points."""
    atlas: Values
    """(E, K) values of the atlas entries."""
    exact: Exact | None
    """None if all nodes have their own colours."""

    @classmethod
    def of_present_points(cls, data: CubeData, points: Values, atlas: Values, exact: Exact) -> "NodeTable":
        """Make a table from values (m, K) of the present points."""
        moving = None if data.inexact_cells is None else exact
        if data.complete_cells is None:
            return cls(data, points, atlas, moving)
        lattice = np.full((data.lattice.size, points.shape[1]), np.nan, points.dtype)
        lattice[data.points.present] = points
        return cls(data, lattice, atlas, moving)

    def spectra(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``spectra``."""
        return np.clip(self.values(rgb), 0, 1)

    def nearest(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``nearest``."""
        points, rows, entry = around(self.data, rgb).nearest()
        values = self.lattice[points]
        values[rows] = self.atlas[entry]
        return values

    def values(self, rgb: Array) -> Values:
        """Weighted values (n, K) of the nodes."""
        values = around(self.data, rgb).weighted_sum(self.lattice, self.atlas)
        if self.exact is not None:
            rows, moved = self.exact(rgb)
            values[rows] = moved
        return values

    def times(self, matrix: Array) -> "NodeTable":
        """Multiply values (…, N) by a matrix (K, N): interpolation is linear, and is faster of fewer numbers."""
        # (Σ w g) Mᵀ = Σ w (g Mᵀ)
        lattice, atlas = ((each @ matrix.T).astype(each.dtype) for each in (self.lattice, self.atlas))
        return NodeTable(self.data, lattice, atlas, self.exact and partial(_product, self.exact, matrix))


def _product(exact: Exact, matrix: Array, rgb: Array) -> tuple[Indices, Array]:
    rows, values = exact(rgb)
    return rows, values @ matrix.T


def _exact_spectra(data: CubeData, wavelengths: Array, rgb: Array) -> tuple[Indices, Array]:
    rows = inexact_rows(data, rgb)
    return rows, spectra(data, rgb[rows], wavelengths)


def _exact_coefficients(
    coefficients: Callable[[CubeData, Array], Array], data: CubeData, rgb: Array
) -> tuple[Indices, Array]:
    rows, _ = fading_rows(data, rgb)
    return rows, coefficients(data, rgb[rows])


def prepare_products(data: CubeData, wavelengths: Array, matrix: Array, threads: int = 1) -> Callable[..., Values]:
    """Prepare products (…, K) of a matrix (K, N) and reflectances in mode ``spectra`` at linear RGB (…, 3), float32."""
    return partial(_sample, tabulate(data, wavelengths, np.float32, threads).times(matrix), threads)


def _sample(table: NodeTable, threads: int, rgb: ArrayLike) -> Values:
    def work(rows: Array) -> Values:
        return table.values(as_colours(rows, table.data.sensor))

    return blockwise(work, as_rgb(rgb), table.lattice.shape[1], table.lattice.dtype, threads)


def tabulate(data: CubeData, wavelengths: Array, dtype: DTypeLike = np.float64, threads: int = 1) -> NodeTable:
    """Compute the reflectances of all nodes at wavelengths (N,) in nm: dim³ × N numbers."""
    evaluate_rows = partial(reflectance, data.model, wavelengths=wavelengths)
    stored = data.points.coefficients[data.points.present]
    present = blockwise(evaluate_rows, stored, len(wavelengths), dtype, threads)
    entries = data.atlas.spectra.reflectance(np.arange(len(data.atlas.names)), wavelengths)
    exact = partial(_exact_spectra, data, wavelengths)
    return NodeTable.of_present_points(data, present, entries.astype(dtype, copy=False), exact)


def tabulate_coefficients(data: CubeData, count: int, dtype: DTypeLike = np.float64, threads: int = 1) -> NodeTable:
    """Tabulate the coefficients of all nodes, ``count`` each: as many as the nodes or the entries have."""
    present = data.points.coefficients[data.points.present]
    entries, exact = data.atlas.coefficients, partial(_exact_coefficients, coefficients, data)
    if count != data.model.count:
        present = blockwise(partial(extend_coefficients, data), present, count, dtype, threads)
        entries = data.atlas.spectra.coefficients
        exact = partial(_exact_coefficients, extended_coefficients, data)
    present, entries = (each.astype(dtype, copy=False) for each in (present, entries))
    return NodeTable.of_present_points(data, present, entries, exact)
