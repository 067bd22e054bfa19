"""Sparse cubes without a fit: whole ones, robbed of points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uplift.cube import CubeData
from uplift.lattice import Status


def robbed(data: CubeData, present) -> CubeData:
    """The cube with the points ``present`` (dim³,) alone, all else as a build for a scene leaves it."""
    gone = ~present
    changed = {name: getattr(data, name).copy() for name in ("coefficients", "rgb", "distance")}
    status, entry = data.status.copy(), data.entry.copy()
    status[gone], entry[gone] = Status.ABSENT, -1
    for name in ("round", "standard_error"):
        if getattr(data, name) is not None:
            changed[name] = getattr(data, name).copy()
    for name, array in changed.items():
        array[gone] = -1 if name == "round" else 0
    return replace(data, status=status, entry=entry, **changed)


def dark(data: CubeData) -> np.ndarray:
    """Which points (dim³,) the cells near black have: a quarter of the axes."""
    position = data.lattice.position(np.arange(data.lattice.size))
    return (position <= data.lattice.dim // 4).all(axis=1)
