"""Tables of the values of all nodes, for queries of at least as many colours as the
cube has nodes.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from uplift.colorimetry.sensor import as_rgb
from uplift.common.arrays import Array, Indices, Values
from uplift.cube.data import CubeData
from uplift.lookup import interpolate
from uplift.lookup.blocks import Function, as_colours, blockwise
from uplift.models.model import reflectance

Exact = Callable[[Array], tuple[Indices, Array]]
"""From linear RGB (n, 3) to the rows (m,) that are moved as nodes have not their own
colours, and values (m, K).
"""


@dataclass(frozen=True, eq=False, repr=False)
class NodeTable:
    """Values of all nodes, float64 or float32."""

    data: CubeData
    lattice: Values
    """(dim³, K) values of the lattice, NaN at absent nodes."""
    atlas: Values
    """(E, K) values of the atlas entries."""
    exact: Exact | None
    """None if all nodes have their own colours."""

    @classmethod
    def of_present_points(
        cls,
        data: CubeData,
        points: Values,
        atlas: Values,
        exact: Exact,
        dtype: DTypeLike,
    ) -> "NodeTable":
        """Make a table of a type from values (m, K) of the present nodes."""
        lattice = points.astype(dtype, copy=False)
        if data.is_sparse:
            lattice = np.full((data.lattice.size, points.shape[1]), np.nan, dtype)
            lattice[data.points.present] = points
        entries = atlas.astype(dtype, copy=False)
        moved = None if data.inexact_cells is None else exact
        return cls(data, lattice, entries, moved)

    def spectra(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``spectra``."""
        return np.clip(self.values(rgb), 0, 1)

    def nearest(self, rgb: Array) -> Values:
        """Reflectance (n, N) in mode ``nearest``."""
        points, rows, entry = interpolate.around(self.data, rgb).nearest()
        values = self.lattice[points]
        values[rows] = self.atlas[entry]
        return values

    def values(self, rgb: Array) -> Values:
        """Weighted values (n, K) of the nodes."""
        nodes = interpolate.around(self.data, rgb)
        values = nodes.weighted_sum(self.lattice, self.atlas)
        if self.exact is not None:
            rows, moved = self.exact(rgb)
            values[rows] = moved
        return values


def _exact(share: Function, values: Function, rgb: Array) -> tuple[Indices, Array]:
    rows = np.flatnonzero(share(rgb))
    return rows, values(rgb[rows])


def prepare_products(
    data: CubeData, wavelengths: Array, matrix: Array, threads: int = 1
) -> Callable[..., Values]:
    """Prepare products (…, K) of a matrix (K, N) and reflectances in mode ``spectra``
    at linear RGB (…, 3), float32.
    """
    # (Σ w g) Mᵀ = Σ w (g Mᵀ): interpolation is linear, and is faster of fewer numbers.
    table = tabulate(data, wavelengths, np.float32, threads)
    lattice, atlas = (
        (values @ matrix.T).astype(np.float32)
        for values in (table.lattice, table.atlas)
    )
    exact = table.exact and partial(_product, table.exact, matrix)
    products = NodeTable(data, lattice, atlas, exact)
    return partial(_sample, products, threads)


def _product(exact: Exact, matrix: Array, rgb: Array) -> tuple[Indices, Array]:
    rows, values = exact(rgb)
    return rows, values @ matrix.T


def _sample(table: NodeTable, threads: int, rgb: ArrayLike) -> Values:
    def work(rows: Array) -> Values:
        return table.values(as_colours(rows, table.data.sensor))

    width = table.lattice.shape[1]
    return blockwise(work, as_rgb(rgb), width, np.float32, threads)


def tabulate(
    data: CubeData, wavelengths: Array, dtype: DTypeLike = np.float64, threads: int = 1
) -> NodeTable:
    """Compute the reflectances of all nodes at wavelengths (N,) in nm: dim³ × N
    numbers.
    """
    evaluate_rows = partial(reflectance, data.model, wavelengths=wavelengths)
    stored = data.points.coefficients[data.points.present]
    present = blockwise(evaluate_rows, stored, len(wavelengths), dtype, threads)
    entries = data.atlas.spectra.reflectance(
        np.arange(len(data.atlas.names)), wavelengths
    )
    spectra = partial(interpolate.spectra, data, wavelengths=wavelengths)
    exact = partial(_exact, partial(interpolate.is_inexact, data), spectra)
    return NodeTable.of_present_points(data, present, entries, exact, dtype)


def tabulate_coefficients(
    data: CubeData, count: int, dtype: DTypeLike = np.float64, threads: int = 1
) -> NodeTable:
    """Tabulate the coefficients of all nodes, ``count`` each: as many as the nodes or
    the entries have.
    """
    present = data.points.coefficients[data.points.present]
    entries = data.atlas.coefficients
    coefficients = interpolate.coefficients
    if count != data.model.count:
        extend_rows = partial(interpolate.in_entry_model, data)
        present = blockwise(extend_rows, present, count, dtype, threads)
        entries = data.atlas.spectra.coefficients
        coefficients = interpolate.extended_coefficients
    share = partial(interpolate.fading_share, data)
    exact = partial(_exact, share, partial(coefficients, data))
    return NodeTable.of_present_points(data, present, entries, exact, dtype)
