"""What a cube stores of a fit, and how near its colours come: judged by what any reader will see."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import numpy as np
from numpy.typing import NDArray

from uplift.fit.batch import batches, put, put_all
from uplift.fit.problem import Problem
from uplift.fit.quadrature import compiled
from uplift.fit.watch import Storing, Watch
from uplift.models import Model
from uplift.models.least_change import Forward, reached
from uplift.sensor import Array

BLOCK = 1 << 15
"""Points worked on at a time."""


class Stored(NamedTuple):
    """Coefficients (n, C), the linear RGB (n, 3) that they have, and max |goal − RGB| (n,)."""

    coefficients: Array
    rgb: NDArray[np.float32]
    distance: NDArray[np.float32]


def store(problem: Problem, multipliers: Array, watch: Watch) -> Stored:
    """The multipliers (n, C) of all points as coefficients, in their place: large lattices have no room for both."""
    model, size = problem.model, len(multipliers)
    stored = Stored(multipliers, np.empty((size, 3), dtype=np.float32), np.empty(size, dtype=np.float32))
    for first in range(0, size, BLOCK):
        block = slice(first, first + BLOCK)
        stored.coefficients[block] = model.to_storage(multipliers[block], compiled)
        rgb = rgb_of(problem, model.from_storage(stored.coefficients[block]))
        goal = problem.goal(np.arange(first, first + len(rgb)))
        stored.rgb[block], stored.distance[block] = rgb, np.abs(goal - rgb).max(axis=1)
        watch(Storing(first + len(rgb), size))
    return stored


def rgb_of(problem: Problem, multipliers: Array) -> Array:
    """Linear RGB (n, 3) of multipliers (n, C)."""
    rgb = np.empty((len(multipliers), 3))
    with jax.enable_x64(True):
        forward = put_all(problem.forward)
        for rows, padded in batches(np.arange(len(multipliers))):
            found = _reached(problem.model, forward, put(multipliers[padded]))
            rgb[rows] = np.asarray(found)[: len(rows)]
    return rgb


@partial(jax.jit, static_argnums=0)
def _reached(model: Model, forward: Forward, multipliers: jax.Array) -> jax.Array:
    return reached(model, forward, multipliers)
