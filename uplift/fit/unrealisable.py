"""Unrealisable lattice points, frequent in wide gamuts, and the realisable colours that replace them in the fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.solid import solid, toward_grey
from uplift.common.arrays import Array, Indices
from uplift.lattice import CORNERS, Lattice

BLOCK_POINTS = 1 << 15
"""Points processed at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class Unrealisable:
    """Lattice points whose colour no reflectance has.

    Parameters
    ----------
    points : ndarray of int, shape (k,)
        Point numbers, ascending.
    nearest : ndarray, shape (k, 3)
        Nearest realisable linear RGB on the straight line to the grey of the same luminance. It has the same hue and
        less chroma.
    """

    points: Indices
    nearest: Array


NONE = Unrealisable(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))


def unrealisable(lattice: Lattice, sensor: Sensor, margin: float, active_points: Indices | None = None) -> Unrealisable:
    """Find the unrealisable points of a lattice.

    Parameters
    ----------
    lattice : Lattice
        The lattice.
    sensor : Sensor
        RGB space, illuminant and observer.
    margin : float
        Linear RGB between the nearest colours and the boundary of the object-colour solid. The spectra on the boundary
        are steps between 0 and 1 (MacAdam 1935), which no smooth model has.
    active_points : ndarray of int, shape (k,), optional
        Points to test, ascending. All by default.

    Returns
    -------
    Unrealisable
        The points, and the nearest realisable colours.
    """
    limits = solid(sensor.matrix)
    if limits.contains(CORNERS.astype(float)).all():
        return NONE  # the solid is convex: it contains everything between the corners
    active = np.arange(lattice.size) if active_points is None else active_points
    points, nearest = [NONE.points], [NONE.nearest]
    for first in range(0, len(active), BLOCK_POINTS):
        block = active[first : first + BLOCK_POINTS]
        outside = block[~limits.contains(lattice.target(block))]
        target = lattice.target(outside)
        points.append(outside)
        nearest.append(toward_grey(limits, sensor.grey(target), target, margin))
    return Unrealisable(np.concatenate(points), np.concatenate(nearest))
