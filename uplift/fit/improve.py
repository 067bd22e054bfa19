"""The improvement pass for nodes that growth left over the threshold (Tódová 2020, section 3.1.4).

The thesis moves Ceres out of local minima in moment space. In multipliers, the first step (more iterations) fixes
nearly every realisable node. A start from grey fixes nodes whose neighbours were black or white, where the gradient
vanishes. The steps of the thesis remain for the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.growth import Growth
from uplift.lattice import NOT_FITTED

MAX_PASSES = 192
NUDGE = 0.5
EXTREME = 100.0
"""Linear part of a nearly white (+) or nearly black (−) spectrum."""
STEPS = (
    "more iterations",
    "from grey",
    "constant multiplier nudged",
    "all multipliers nudged",
    "from white or black",
)
THESIS_STEPS = (
    "constant multiplier nudged",
    "all multipliers nudged",
    "more iterations",
    "from white or black",
    "from white or black, constant multiplier nudged",
    "from white or black, all multipliers nudged",
)
"""The order of Tódová 2020, section 3.1.4."""


class Improvement(NamedTuple):
    """A step, the nodes that were over the threshold before it, and those of them that are within it afterwards."""

    step: str
    tried: int
    fixed: int


def improve(growth: Growth, steps: Sequence[str] = STEPS) -> tuple[Improvement, ...]:
    """Improve nodes in place. Each step tries those that are still over the threshold; no distance increases."""
    problem, points, done = growth.problem, growth.nodes.points, []
    for step in steps:
        points = points[growth.distance[points] > problem.threshold]
        if not points.size:
            break
        # +1 for goals nearer to white, −1 for those nearer to black, at all wavelengths.
        sign = np.where(growth.nodes.goal(points).mean(axis=1) >= 0.5, 1.0, -1.0)
        start = _start(step, growth.multipliers[points], sign[:, None] * problem.model.constant())
        growth.attempt(points, start, NOT_FITTED, max_passes=MAX_PASSES)
        fixed = int((growth.distance[points] <= problem.threshold).sum())
        done.append(Improvement(step, len(points), fixed))
    return tuple(done)


def _start(step: str, best: Array, extreme: Array) -> Array:
    """Multipliers (k, C) that a step starts from, of the best so far and of a linear part of ±1."""
    # Alternating nudges, the same for every node and every run: no direction is better justified than another.
    alternating = NUDGE * (-1.0) ** np.arange(best.shape[1])
    return {
        "more iterations": best,
        "from grey": np.zeros_like(best),
        "constant multiplier nudged": best + NUDGE * extreme,
        "all multipliers nudged": best + alternating,
        "from white or black": EXTREME * extreme,
        "from white or black, constant multiplier nudged": (EXTREME - NUDGE) * extreme,
        "from white or black, all multipliers nudged": EXTREME * extreme + alternating,
    }[step]
