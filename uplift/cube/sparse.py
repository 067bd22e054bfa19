"""Sparse cubes: their file holds the points that are present alone, and the number of each (docs/cube-file.md)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Mask
from uplift.lattice import Status

FEATURE = "sparse"
POINTS = "points"
"""The array of their numbers, ascending."""
MOST = 1 << 27
"""Points of the largest lattice that a sparse file may speak of: a small file shall not claim all memory."""
ABSENT = {"status": int(Status.ABSENT), "entry": -1, "round": -1}
"""What arrays have at absent points; all others 0."""

Tensors = dict[str, NDArray[Any]]


def gather(tensors: Tensors, names: Iterable[str], present: Mask) -> Tensors:
    """The same with the arrays ``names`` (n, …) at the points ``present`` (n,) alone, and the points' numbers."""
    rows = {name: np.ascontiguousarray(tensors[name][present]) for name in names if name in tensors}
    return {**tensors, **rows, POINTS: np.flatnonzero(present).astype(np.uint32)}


def scatter(tensors: Tensors, names: Iterable[str], size: int) -> Tensors:
    """The same with the arrays ``names`` (m, …) as (size, …). Raises `ValueError` where points have no place."""
    points = tensors[POINTS]
    numbers = points.dtype == np.uint32 and points.ndim == 1 and 0 < len(points) < size <= MOST
    if not (numbers and (points[1:] > points[:-1]).all() and points[-1] < size):
        raise ValueError("it does not hold that points ascend within the lattice, some of them missing")
    whole = {name: _spread(name, tensors[name], points, size) for name in names if name in tensors}
    return {**tensors, **whole}


def _spread(name: str, rows: NDArray[Any], points: NDArray[np.uint32], size: int) -> NDArray[Any]:
    if rows.shape[:1] != points.shape:
        raise ValueError(f"it does not hold that every point has its {name}")
    shape = (size, *rows.shape[1:])
    # Zeros take no memory before they are written to.
    spread = np.full(shape, ABSENT[name], rows.dtype) if name in ABSENT else np.zeros(shape, rows.dtype)
    spread[points] = rows
    return spread
