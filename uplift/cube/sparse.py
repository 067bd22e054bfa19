"""Sparse cubes: their files store the present points only, with their numbers (docs/cube-file.md)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Mask
from uplift.cube.checks import require
from uplift.lattice import NO_ENTRY, NOT_FITTED, Status

FEATURE = "sparse"
POINTS = "points"
"""The array of point numbers, ascending."""
MAX_POINTS = 1 << 27
"""Points of the largest lattice of a sparse file, as a small file must not claim all memory."""
ABSENT = {"status": int(Status.ABSENT), "entry": NO_ENTRY, "round": NOT_FITTED}
"""Values of arrays at absent points; 0 in all others."""

Tensors = dict[str, NDArray[Any]]


def gather(tensors: Tensors, names: Iterable[str], present: Mask) -> Tensors:
    """Reduce the arrays ``names`` (n, …) to the points ``present`` (n,), and add their numbers."""
    rows = {name: np.ascontiguousarray(tensors[name][present]) for name in names if name in tensors}
    return {**tensors, **rows, POINTS: np.flatnonzero(present).astype(np.uint32)}


def scatter(tensors: Tensors, names: Iterable[str], size: int) -> Tensors:
    """Expand the arrays ``names`` (m, …) to (size, …); `CubeFileError` if the point numbers are invalid."""
    points = tensors[POINTS]
    valid = points.dtype == np.uint32 and points.ndim == 1 and 0 < len(points) < size <= MAX_POINTS
    ascending = valid and bool((points[1:] > points[:-1]).all() and points[-1] < size)
    require(ascending, "invalid-points", "point numbers must ascend within the lattice, with some missing")
    expanded = {name: _expand(name, tensors[name], points, size) for name in names if name in tensors}
    return {**tensors, **expanded}


def _expand(name: str, rows: NDArray[Any], points: NDArray[np.uint32], size: int) -> NDArray[Any]:
    require(rows.shape[:1] == points.shape, "invalid-array", f"{name} must have a row for every point")
    shape = (size, *rows.shape[1:])
    # Pages of zeros take no memory before they are written.
    array = np.full(shape, ABSENT[name], rows.dtype) if name in ABSENT else np.zeros(shape, rows.dtype)
    array[points] = rows
    return array
