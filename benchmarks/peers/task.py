"""What every peer is asked: the points of our sRGB lattice, or some of them, under our sensor; and the clock."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cache

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.timing import Spread, spread
from uplift.lattice import Lattice

DIM = 16


@cache
def sensor() -> Sensor:
    """CIE 1931 observer, D65, linear sRGB."""
    return observer.sensor()


@cache
def lattice(dim: int = DIM) -> Lattice:
    """Nodes spaced as sRGB."""
    return Lattice(observer.axis_nodes("srgb", dim))


def some(count: int) -> Array:
    """(count, 3) linear RGB: points of the lattice drawn at random, always the same."""
    points = lattice().points
    return points[np.random.default_rng(16).choice(len(points), count, replace=False)]


def measured(solve: Callable[[], Array], points: int, runs: int) -> tuple[Array, Spread]:
    """What ``solve`` finds, and µs of CPU per point. Some peers are too slow to run once more for the answer."""
    found, seconds = np.empty(0), []
    for _ in range(runs):
        begin = time.process_time()
        found = solve()
        seconds.append(time.process_time() - begin)
    return found, spread(seconds).scaled(1e6 / points)
