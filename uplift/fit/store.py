"""Storage of growth: multipliers as coefficients, the colours of what is stored, and the status of every node."""

from __future__ import annotations

from typing import Any

import jax
import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Indices
from uplift.common.progress import Progress
from uplift.fit.batch import map_batches, to_storage
from uplift.fit.growth import Growth, blocks
from uplift.fit.seeds import Seeds
from uplift.lattice import NO_ENTRY, NOT_FITTED, PointTable, Status
from uplift.models.minimum_norm import ForwardMap

SINGLE: np.dtype[Any] = np.dtype(np.float32)
DOUBLE: np.dtype[Any] = np.dtype(np.float64)
MAX_LOSS = 0.1
"""Part of the threshold that single precision may add to the distance of a node; docs/stability.md."""
_rgb = jax.jit(ForwardMap.rgb)


def store(growth: Growth, seeds: Seeds, standard_error: NDArray[np.float32] | None) -> PointTable:
    """Return the table of all nodes. RGB, distance and status are those of the stored coefficients.

    Unrealisable nodes are fitted to the nearest realisable colour; their distance is measured from their own.
    """
    nodes, threshold = growth.nodes, growth.problem.threshold
    coefficients, rgb, distance = _store_coefficients(growth)
    # The entry that a node started from, and its status: later lines overrule earlier ones.
    entry = np.full(nodes.lattice.size, NO_ENTRY, dtype=np.int32)
    entry[seeds.points] = seeds.entry
    status = np.full(nodes.lattice.size, Status.REGULAR, dtype=np.uint8)
    status[seeds.points] = np.where(seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER)
    status[growth.round == NOT_FITTED] = Status.IMPROVED
    outside = nodes.unrealisable
    status[outside] = Status.UNREALISABLE
    status[distance > threshold] = Status.UNFITTED
    distance[outside] = np.abs(nodes.lattice.target(outside) - rgb[outside]).max(axis=1)
    status[outside[distance[outside] <= threshold]] = Status.REGULAR
    absent = np.ones(nodes.lattice.size, dtype=bool)
    absent[nodes.points] = False
    status[absent], entry[absent] = Status.ABSENT, NO_ENTRY
    return PointTable(coefficients, rgb, distance, status, entry, growth.round, standard_error)


def _store_coefficients(growth: Growth) -> tuple[NDArray[Any], NDArray[np.float32], NDArray[np.float32]]:
    """Coefficients (n, C), their linear RGB (n, 3) and distances (n,), all 0 at nodes that are not fitted.

    The coefficients are float32 if that is accurate enough for every node, else float64 for all. Where rounding them
    cannot change the colour (`Model.is_float32_safe`), the colour is that of the solver; elsewhere it is evaluated from
    the rounded coefficients. They overwrite the multipliers, as memory for both may not suffice.
    """
    problem, points, kind = growth.problem, growth.nodes.points, SINGLE
    coefficients, rgb, distance = growth.multipliers, growth.rgb, np.zeros(len(growth.rgb), dtype=np.float32)

    def evaluate(block: Indices) -> None:
        if block.size:
            values = map_batches(_rgb, problem.forward, problem.model.from_storage(coefficients[block].astype(kind)))
            rgb[block], distance[block] = values, np.abs(growth.nodes.goal(block) - values).max(axis=1)

    # Block by block; once a block loses too much in single precision, all sensitive nodes so far are evaluated again.
    sensitive = [points[:0]]
    for block in blocks(points):
        multipliers = growth.multipliers[block]
        safe = problem.model.is_float32_safe(multipliers)
        coefficients[block] = to_storage(problem.model, multipliers)
        distance[block] = growth.distance[block]
        sensitive.append(block[~safe])
        evaluate(sensitive[-1])
        limit = growth.distance[sensitive[-1]] + MAX_LOSS * problem.threshold
        if kind == SINGLE and (distance[sensitive[-1]] > limit).any():
            kind = DOUBLE
            for earlier in sensitive:
                evaluate(earlier)
        growth.progress(Progress("store", int(np.searchsorted(points, block[-1])) + 1, len(points)))
    return coefficients.astype(kind, copy=False), rgb, distance
