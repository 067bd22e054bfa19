"""Sparse cubes: their files store the present points only, with their numbers (docs/cube-file.md)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Indices, Mask
from uplift.cube.checks import require
from uplift.lattice import ABSENT_VALUES, CORNERS, Lattice, PointTable

FEATURE = "sparse"
POINTS = "points"
"""The array of point numbers, ascending."""
MAX_POINTS = 1 << 27
"""Points of the largest lattice of a sparse file, as a small file must not claim all memory."""

Tensors = dict[str, NDArray[Any]]


def gather(tensors: Tensors, names: Iterable[str], present: Mask) -> Tensors:
    """Reduce the arrays ``names`` (n, …) to the points ``present`` (n,), and add their numbers."""
    rows = {name: np.ascontiguousarray(tensors[name][present]) for name in names if name in tensors}
    return {**tensors, **rows, POINTS: np.flatnonzero(present).astype(np.uint32)}


def expand(points: PointTable, numbers: NDArray[Any], lattice: Lattice) -> PointTable:
    """Expand the arrays (m, …) of stored points to those of the lattice, (n, …).

    Raises `CubeFileError` if the point ``numbers`` (m,) are invalid, before anything is allocated.
    """
    _check_numbers(numbers, len(points), lattice)
    rows = {field.name: getattr(points, field.name) for field in fields(points)}
    arrays: dict[str, Any] = {
        name: None if array is None else _expand(name, array, numbers, lattice.size) for name, array in rows.items()
    }
    return PointTable(**arrays)


def _check_numbers(numbers: NDArray[Any], stored: int, lattice: Lattice) -> None:
    size = lattice.size
    valid = numbers.dtype == np.uint32 and numbers.ndim == 1 and 0 < len(numbers) < size <= MAX_POINTS
    ascending = valid and bool((numbers[1:] > numbers[:-1]).all() and numbers[-1] < size)
    require(ascending, "invalid-points", "point numbers must ascend within the lattice, with some missing")
    require(len(numbers) == stored, "invalid-array", "every array must have a row for every point")
    complete = _has_complete_cell(numbers.astype(np.int64), lattice)
    require(complete, "no-complete-cell", "one cell must have all its corners")


def _has_complete_cell(numbers: Indices, lattice: Lattice) -> bool:
    low = numbers[(lattice.position(numbers) < lattice.dim - 1).all(axis=-1)]
    for corner in CORNERS:
        low = low[np.isin(low + lattice.index(corner), numbers, assume_unique=True)]
    return bool(low.size)


def _expand(name: str, rows: NDArray[Any], points: NDArray[np.uint32], size: int) -> NDArray[Any]:
    shape = (size, *rows.shape[1:])
    # Pages of zeros take no memory before they are written.
    array = np.full(shape, ABSENT_VALUES[name], rows.dtype) if name in ABSENT_VALUES else np.zeros(shape, rows.dtype)
    array[points] = rows
    return array
