"""Storage of growth: multipliers as coefficients, the colours of what is stored, and
the status of every node.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Indices, blocks, largest
from uplift.common.progress import Progress
from uplift.fit.batch import to_storage
from uplift.fit.growth import BLOCK_POINTS, Growth
from uplift.fit.prior import Prior
from uplift.fit.seeds import Seeds
from uplift.fit.solver import residuals
from uplift.lattice.point_table import NO_ENTRY, NOT_FITTED, PointTable, Status

SINGLE: np.dtype[Any] = np.dtype(np.float32)
DOUBLE: np.dtype[Any] = np.dtype(np.float64)
MAX_LOSS = 0.1
"""Part of the threshold that single precision may add to the distance of a node."""


def store(growth: Growth, seeds: Seeds, prior: Prior) -> PointTable:
    """Return the table of all nodes. RGB, distance and status are those of the stored
    coefficients.

    Unrealisable nodes are fitted to a realisable colour of less chroma; their distance
    is measured from their own.
    """
    nodes = growth.nodes
    lattice = growth.nodes.lattice
    threshold = growth.problem.threshold
    coefficients, distance, standard_error = _store_coefficients(growth, prior)
    # The entry that a node started from, and its status: later lines overrule earlier
    # ones.
    entry = np.full(lattice.size, NO_ENTRY, dtype=np.int32)
    entry[seeds.points] = seeds.entry
    status = np.full(lattice.size, Status.REGULAR, dtype=np.uint8)
    status[seeds.points] = np.where(
        seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER
    )
    status[growth.round == NOT_FITTED] = Status.IMPROVED
    outside = nodes.unrealisable
    status[outside] = Status.UNREALISABLE
    status[distance > threshold] = Status.UNFITTED
    distance[outside] = np.abs(lattice.target(outside) - growth.rgb[outside]).max(
        axis=1
    )
    status[outside[distance[outside] <= threshold]] = Status.REGULAR
    absent = ~lattice.mask(nodes.points)
    status[absent] = Status.ABSENT
    entry[absent] = NO_ENTRY
    return PointTable(
        coefficients,
        growth.rgb,
        distance,
        status,
        entry=entry,
        round=growth.round,
        standard_error=standard_error,
    )


def _store_coefficients(
    growth: Growth, prior: Prior
) -> tuple[NDArray[Any], NDArray[np.float32], NDArray[np.float32] | None]:
    """Coefficients (n, C), their distances (n,) and standard errors (n,), all 0 at
    nodes that are not to be fitted.

    The coefficients are float32 if that is accurate enough for every node, else float64
    for all. Where rounding them cannot change the colour (`Model.is_float32_safe`), the
    colour is that of the solver; elsewhere it is evaluated from the rounded
    coefficients. They overwrite the multipliers, as memory for both may not suffice.
    """
    problem = growth.problem
    nodes = growth.nodes
    kind = SINGLE
    coefficients = growth.multipliers
    distance = np.zeros(len(growth.rgb), dtype=np.float32)
    standard_error = None if prior.errors is None else np.zeros_like(distance)

    def evaluate(points: Indices) -> None:
        if points.size:
            multipliers = problem.model.from_storage(coefficients[points].astype(kind))
            goal = nodes.goal(points)
            residual = residuals(problem.forward, multipliers, goal, problem.method)
            growth.rgb[points] = goal - residual
            distance[points] = largest(np.abs(residual))

    # Block by block; once a block loses too much in single precision, all sensitive
    # nodes so far are evaluated again.
    sensitive = []
    for block in blocks(len(nodes.points), BLOCK_POINTS):
        points = nodes.points[block]
        safe = problem.model.is_float32_safe(coefficients[points])
        coefficients[points] = to_storage(problem.model, coefficients[points])
        distance[points] = growth.distance[points]
        sensitive.append(points[~safe])
        evaluate(sensitive[-1])
        limit = growth.distance[sensitive[-1]] + MAX_LOSS * problem.threshold
        if kind == SINGLE and (distance[sensitive[-1]] > limit).any():
            kind = DOUBLE
            for earlier in sensitive:
                evaluate(earlier)
        if standard_error is not None:
            standard_error[points] = prior.standard_error(nodes.lattice.target(points))
        growth.progress(Progress("store", block.stop, len(nodes.points)))
    return coefficients.astype(kind, copy=False), distance, standard_error
