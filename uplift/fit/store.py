"""Convert multipliers to stored coefficients, and evaluate the colours of what is stored."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress
from uplift.fit.batch import batches, replicate, shard
from uplift.fit.growth import Growth, blocks
from uplift.fit.problem import Problem
from uplift.fit.quadrature_jit import COMPILED
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_rgb

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


def store(growth: Growth) -> StoredPoints:
    """Convert the multipliers of growth to coefficients.

    The coefficients are float32 if that is accurate enough for every point, else float64 for all. Where rounding them
    cannot change the colour (`Model.rounds_safely`), the colour is that of the solver; elsewhere it is evaluated from
    the rounded coefficients. The multipliers are overwritten, as memory for both may not suffice.
    """
    problem, kind = growth.problem, SINGLE
    model, points = problem.model, problem.points
    stored = StoredPoints(growth.multipliers, growth.rgb, np.zeros(len(growth.rgb), dtype=np.float32))
    sensitive = [points[:0]]
    for block in blocks(points):
        multipliers = growth.multipliers[block]
        safe = model.rounds_safely(multipliers)
        stored.coefficients[block] = model.to_storage(multipliers, COMPILED)
        stored.distance[block] = growth.distance[block]
        sensitive.append(block[~safe])
        _evaluate(problem, stored, sensitive[-1], kind)
        limit = growth.distance[sensitive[-1]] + MAX_LOSS * problem.threshold
        if kind == SINGLE and (stored.distance[sensitive[-1]] > limit).any():
            kind = DOUBLE
            for earlier in sensitive:
                _evaluate(problem, stored, earlier, kind)
        growth.progress(Progress("store", int(np.searchsorted(points, block[-1])) + 1, len(points)))
    return stored._replace(coefficients=stored.coefficients.astype(kind, copy=False))


def _evaluate(problem: Problem, stored: StoredPoints, block: Indices, kind: np.dtype[Any]) -> None:
    """Set RGB and distance of points (k,) from their coefficients, rounded to the type that is stored."""
    rgb = rgb_of(problem, problem.model.from_storage(stored.coefficients[block].astype(kind)))
    stored.rgb[block], stored.distance[block] = rgb, np.abs(problem.goal(block) - rgb).max(axis=1)


def rgb_of(problem: Problem, multipliers: Array) -> Array:
    """Linear RGB (n, 3) of multipliers (n, C)."""
    rgb = np.empty((len(multipliers), 3))
    with jax.enable_x64(True):
        forward = replicate(problem.forward)
        for rows, width in batches(len(multipliers)):
            part = rgb[rows]
            found = _forward_rgb(problem.model, forward, shard(multipliers[rows], width))
            part[:] = np.asarray(found)[: len(part)]
    return rgb


@partial(jax.jit, static_argnums=0)
def _forward_rgb(model: Model, forward: ForwardMap, multipliers: jax.Array) -> jax.Array:
    return forward_rgb(model, forward, multipliers)
