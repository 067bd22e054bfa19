"""The task of every tool: nodes of the sRGB lattice under the default sensor; and its timing."""

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
    """Return the sensor: CIE 1931 observer, D65, linear sRGB."""
    return observer.sensor()


@cache
def lattice(dim: int = DIM) -> Lattice:
    """Return a lattice with nodes spaced as sRGB."""
    return Lattice(observer.axis_nodes("srgb", dim))


def some(count: int) -> Array:
    """Return linear RGB (count, 3) of random nodes of the lattice, always the same."""
    points = lattice().points
    return points[np.random.default_rng(16).choice(len(points), count, replace=False)]


def measured(solve: Callable[[], Array], points: int, runs: int) -> tuple[Array, Spread]:
    """Return the result of ``solve``, and µs of CPU per node. Some tools are too slow for a separate run."""
    solution, seconds = np.empty(0), []
    for _ in range(runs):
        begin = time.process_time()
        solution = solve()
        seconds.append(time.process_time() - begin)
    return solution, spread(seconds).scaled(1e6 / points)
