"""The improvement pass for points that growth left over the threshold (Tódová 2020, 3.1.4).

The thesis nudged Ceres out of local minima in moment space. In multipliers the first step, more iterations,
mends nearly every realisable point; starting over from grey mends points whose neighbours were black or white,
where the gradient vanishes; the thesis's own steps stay for the colours nobody has met yet.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.fit.problem import Problem

PASSES = 192
NUDGE = 0.5
EXTREME = 100.0
"""Linear part of a nearly white (+) or nearly black (−) spectrum."""


@dataclass(frozen=True)
class Improvement:
    """One step of the pass: points over the threshold that it was tried on, and how many of them it mended."""

    step: str
    tried: int
    mended: int


Start = Callable[[Array, Array], Array]
"""Multipliers (k, C) to begin from, of the best so far (k, C) and the way (k, C) to white or black, if nearer."""


def _onwards(best: Array, way: Array) -> Array:
    return best


def _grey(best: Array, way: Array) -> Array:
    return np.zeros_like(best)


def _constant_nudged(best: Array, way: Array) -> Array:
    return best + NUDGE * way


def _all_nudged(best: Array, way: Array) -> Array:
    """The same nudges for every point and every run: alternating, as no direction is better founded."""
    return best + NUDGE * (-1.0) ** np.arange(best.shape[1])


def _extreme(best: Array, way: Array) -> Array:
    return EXTREME * way


STEPS: dict[str, Start] = {
    "more iterations": _onwards,
    "from grey": _grey,
    "constant multiplier nudged": _constant_nudged,
    "all multipliers nudged": _all_nudged,
    "from white or black": _extreme,
}


def improve(problem: Problem, multipliers: Array, distance: Array) -> tuple[Improvement, ...]:
    """Better the multipliers (n, C) and distances (n,) of the points, in place, and say what each step did.

    Each step takes the points on that are over the threshold still; none gets worse.
    """
    done = []
    for name, start in STEPS.items():
        points = problem.points[distance[problem.points] > problem.threshold]
        if not points.size:
            break
        begin = start(multipliers[points], _way(problem, points))
        found = problem.solve(problem.goal(points), begin, PASSES)
        better = found.distance < distance[points]
        multipliers[points[better]] = found.multipliers[better]
        distance[points[better]] = found.distance[better]
        mended = int((distance[points] <= problem.threshold).sum())
        done.append(Improvement(name, len(points), mended))
    return tuple(done)


def _way(problem: Problem, points: Indices) -> Array:
    """Multipliers (k, C) of a linear part of +1 for targets nearer to white, −1 for those nearer to black."""
    toward = np.where(problem.goal(points).mean(axis=1) >= 0.5, 1.0, -1.0)
    return toward[:, None] * problem.model.constant()
