"""What a cube stores of a fit, and how near its colours come: judged by what any reader will see."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import jax
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.batch import batches, replicate, shard
from uplift.fit.problem import Problem
from uplift.fit.quadrature_jit import quadrature_jit
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_rgb

BLOCK = 1 << 15
"""Points worked on at a time."""
SINGLE: np.dtype[Any] = np.dtype(np.float32)
DOUBLE: np.dtype[Any] = np.dtype(np.float64)
LOSS = 0.1
"""Share of the threshold that single precision may add to a point's distance; docs/stability.md."""


class StoredPoints(NamedTuple):
    """Coefficients (n, C), the linear RGB (n, 3) that they have, and max |goal − RGB| (n,); 0 if not wanted."""

    coefficients: NDArray[Any]
    rgb: NDArray[np.float32]
    distance: NDArray[np.float32]


def store(problem: Problem, multipliers: Array, distance: Array, progress: ProgressCallback) -> StoredPoints:
    """The multipliers (n, C) of the points as coefficients, which are as far (n,) from their goals.

    float32, if that is as good for every point, or float64 for all. The multipliers give their place: large
    lattices have no room for both.
    """
    model, size, kind, points = problem.model, len(multipliers), SINGLE, problem.points
    stored = StoredPoints(
        multipliers, np.zeros((size, 3), dtype=np.float32), np.zeros(size, dtype=np.float32)
    )
    for done, block in _blocks(points):
        stored.coefficients[block] = model.to_storage(multipliers[block], quadrature_jit)
        _evaluate(problem, stored, block, kind)
        if kind == SINGLE and (stored.distance[block] > distance[block] + LOSS * problem.threshold).any():
            kind = DOUBLE
            for _, again in _blocks(points[:done]):
                _evaluate(problem, stored, again, kind)
        progress(Progress("store", done, len(points)))
    return stored._replace(coefficients=stored.coefficients.astype(kind, copy=False))


def _evaluate(problem: Problem, stored: StoredPoints, block: Indices, kind: np.dtype[Any]) -> None:
    """RGB and distance of points (k,), as whoever reads its coefficients in that type will find them."""
    rgb = rgb_of(problem, problem.model.from_storage(stored.coefficients[block].astype(kind)))
    stored.rgb[block], stored.distance[block] = rgb, np.abs(problem.goal(block) - rgb).max(axis=1)


def _blocks(points: Indices) -> Iterator[tuple[int, Indices]]:
    """Points done after it, and a block of them."""
    for first in range(0, len(points), BLOCK):
        block = points[first : first + BLOCK]
        yield first + len(block), block


def rgb_of(problem: Problem, multipliers: Array) -> Array:
    """Linear RGB (n, 3) of multipliers (n, C)."""
    rgb = np.empty((len(multipliers), 3))
    with jax.enable_x64(True):
        forward = replicate(problem.forward)
        for rows, padded in batches(np.arange(len(multipliers))):
            found = _reached(problem.model, forward, shard(multipliers[padded]))
            rgb[rows] = np.asarray(found)[: len(rows)]
    return rgb


@partial(jax.jit, static_argnums=0)
def _reached(model: Model, forward: ForwardMap, multipliers: jax.Array) -> jax.Array:
    return forward_rgb(model, forward, multipliers)
