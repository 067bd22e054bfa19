"""Sparse cubes without a fit: points of complete cubes marked as absent."""

from __future__ import annotations

import numpy as np

from tests.helpers import with_points
from uplift.cube import CubeData
from uplift.cube.file import POINTS
from uplift.lattice import ABSENT_VALUES


def with_absent_points(data: CubeData, present: np.ndarray) -> CubeData:
    """Return the cube with the points ``present`` (dim³,) only, as a build for a scene returns it."""
    arrays = {name: getattr(data.points, name) for name in POINTS}
    arrays = {name: array.copy() for name, array in arrays.items() if array is not None}
    for name, array in arrays.items():
        array[~present] = ABSENT_VALUES.get(name, 0)
    return with_points(data, **arrays)


def near_black(data: CubeData) -> np.ndarray:
    """Mask (dim³,) of the points in the lowest quarter of every axis."""
    position = data.lattice.position(np.arange(data.lattice.size))
    return (position <= data.lattice.dim // 4).all(axis=1)
