"""Convert multipliers to stored coefficients, and evaluate the colours of what is stored."""

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

BLOCK_POINTS = 1 << 15
"""Points processed at a time."""
SINGLE: np.dtype[Any] = np.dtype(np.float32)
DOUBLE: np.dtype[Any] = np.dtype(np.float64)
MAX_LOSS = 0.1
"""Share of the threshold that single precision may add to the distance of a point; docs/stability.md."""


class StoredPoints(NamedTuple):
    """Result of `store`; all 0 at inactive points."""

    coefficients: NDArray[Any]
    """(n, C) float32 or float64."""
    rgb: NDArray[np.float32]
    """(n, 3) linear RGB of the coefficients."""
    distance: NDArray[np.float32]
    """(n,) max |goal − RGB|."""


def store(problem: Problem, multipliers: Array, distance: Array, progress: ProgressCallback) -> StoredPoints:
    """Convert multipliers (n, C) with distances (n,) to coefficients.

    The coefficients are float32 if that is accurate enough for every point, else float64 for all. The array of
    multipliers is overwritten, as memory for both may not suffice.
    """
    model, size, kind, points = problem.model, len(multipliers), SINGLE, problem.points
    stored = StoredPoints(
        multipliers, np.zeros((size, 3), dtype=np.float32), np.zeros(size, dtype=np.float32)
    )
    for done, block in _blocks(points):
        stored.coefficients[block] = model.to_storage(multipliers[block], quadrature_jit)
        _evaluate(problem, stored, block, kind)
        if kind == SINGLE and (stored.distance[block] > distance[block] + MAX_LOSS * problem.threshold).any():
            kind = DOUBLE
            for _, earlier in _blocks(points[:done]):
                _evaluate(problem, stored, earlier, kind)
        progress(Progress("store", done, len(points)))
    return stored._replace(coefficients=stored.coefficients.astype(kind, copy=False))


def _evaluate(problem: Problem, stored: StoredPoints, block: Indices, kind: np.dtype[Any]) -> None:
    """Set RGB and distance of points (k,) from their coefficients, rounded to the type that is stored."""
    rgb = rgb_of(problem, problem.model.from_storage(stored.coefficients[block].astype(kind)))
    stored.rgb[block], stored.distance[block] = rgb, np.abs(problem.goal(block) - rgb).max(axis=1)


def _blocks(points: Indices) -> Iterator[tuple[int, Indices]]:
    """Blocks of points, each with the number of points up to its end."""
    for first in range(0, len(points), BLOCK_POINTS):
        block = points[first : first + BLOCK_POINTS]
        yield first + len(block), block


def rgb_of(problem: Problem, multipliers: Array) -> Array:
    """Linear RGB (n, 3) of multipliers (n, C)."""
    rgb = np.empty((len(multipliers), 3))
    with jax.enable_x64(True):
        forward = replicate(problem.forward)
        for rows, padded in batches(np.arange(len(multipliers))):
            found = _forward_rgb(problem.model, forward, shard(multipliers[padded]))
            rgb[rows] = np.asarray(found)[: len(rows)]
    return rgb


@partial(jax.jit, static_argnums=0)
def _forward_rgb(model: Model, forward: ForwardMap, multipliers: jax.Array) -> jax.Array:
    return forward_rgb(model, forward, multipliers)
