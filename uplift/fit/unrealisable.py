"""Lattice points whose colours no reflectance has, as wide RGB spaces have many, and what is fitted in their stead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array, Indices
from uplift.lattice import CORNERS, Lattice

BLOCK = 1 << 15
"""Points worked on at a time."""


@dataclass(frozen=True, eq=False)
class Unrealisable:
    """Such points (k,), ascending, and the nearest realisable linear RGB (k, 3) to each.

    Nearest on the straight line to the grey of the same luminance: the hue stays, the chroma goes down.
    """

    points: Indices
    nearest: Array


NONE = Unrealisable(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))


def unrealisable(
    lattice: Lattice, sensor: Sensor, margin: float, wanted: Indices | None = None
) -> Unrealisable:
    """The unrealisable points of a lattice, or of those ``wanted`` (k,), ascending.

    Their nearest colours keep ``margin`` (linear RGB) from the boundary. On the boundary itself are spectra of
    steps between 0 and 1 (MacAdam 1935), which no smooth model reaches.
    """
    limits = solid(sensor.matrix)
    if limits.contains(CORNERS.astype(float)).all():
        return NONE  # the solid is convex, so it holds what lies between as well
    points, nearest = [NONE.points], [NONE.nearest]
    asked = np.arange(lattice.size) if wanted is None else wanted
    for first in range(0, len(asked), BLOCK):
        block = asked[first : first + BLOCK]
        outside = block[~limits.contains(lattice.target(block))]
        target = lattice.target(outside)
        grey = np.clip(sensor.xyz(target)[:, 1:2], 0, 1).repeat(3, axis=1)
        way = target - grey
        inward = margin / np.maximum(np.abs(way).max(axis=1), margin)
        share = np.maximum(limits.ray_fraction(grey, target) - inward, 0)
        points.append(outside)
        nearest.append(grey + share[:, None] * way)
    return Unrealisable(np.concatenate(points), np.concatenate(nearest))
