"""The improvement pass for points that growth left over the threshold (Tódová 2020, section 3.1.4).

The thesis moves Ceres out of local minima in moment space. In multipliers, the first step (more iterations) fixes
nearly every realisable point. A start from grey fixes points whose neighbours were black or white, where the gradient
vanishes. The steps of the thesis remain for the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.fit.growth import Growth
from uplift.fit.problem import Problem
from uplift.lattice import NOT_FITTED

MAX_PASSES = 192
NUDGE = 0.5
EXTREME = 100.0
"""Linear part of a nearly white (+) or nearly black (−) spectrum."""


@dataclass(frozen=True)
class Improvement:
    """One step of the improvement pass.

    Parameters
    ----------
    step : str
        Name of the step.
    tried : int
        Points over the threshold before it.
    fixed : int
        Points of these that are within the threshold after it.
    """

    step: str
    tried: int
    fixed: int

    def to_json(self) -> dict[str, Any]:
        """Return the entry of the provenance.

        Returns
        -------
        dict
            ``step`` and ``tried``; the key of ``fixed`` is that of cube files.
        """
        return {"step": self.step, "tried": self.tried, "mended": self.fixed}


Start = Callable[[Array, Array], Array]
"""From the best multipliers so far (k, C), and multipliers (k, C) of the nearer of white and black, to a start."""


def _more_iterations(best: Array, extreme: Array) -> Array:
    return best


def _grey(best: Array, extreme: Array) -> Array:
    return np.zeros_like(best)


def _constant_nudged(best: Array, extreme: Array) -> Array:
    return best + NUDGE * extreme


def _all_nudged(best: Array, extreme: Array) -> Array:
    """Alternating nudges, the same for every point and every run: no direction is better justified than another."""
    return best + NUDGE * (-1.0) ** np.arange(best.shape[1])


def _white_or_black(best: Array, extreme: Array) -> Array:
    return EXTREME * extreme


STEPS: dict[str, Start] = {
    "more iterations": _more_iterations,
    "from grey": _grey,
    "constant multiplier nudged": _constant_nudged,
    "all multipliers nudged": _all_nudged,
    "from white or black": _white_or_black,
}


def _white_or_black_constant_nudged(best: Array, extreme: Array) -> Array:
    return (EXTREME - NUDGE) * extreme


def _white_or_black_all_nudged(best: Array, extreme: Array) -> Array:
    return _all_nudged(EXTREME * extreme, extreme)


THESIS_STEPS: dict[str, Start] = {
    "constant multiplier nudged": _constant_nudged,
    "all multipliers nudged": _all_nudged,
    "more iterations": _more_iterations,
    "from white or black": _white_or_black,
    "from white or black, constant multiplier nudged": _white_or_black_constant_nudged,
    "from white or black, all multipliers nudged": _white_or_black_all_nudged,
}
"""The order of Tódová 2020, section 3.1.4."""


def improve(growth: Growth, steps: Mapping[str, Start]) -> tuple[Improvement, ...]:
    """Improve points in place, by `STEPS` or `THESIS_STEPS`.

    Each step tries the points that are still over the threshold; no distance increases.
    """
    problem, done = growth.problem, []
    for name, start in steps.items():
        points = problem.points[growth.distance[problem.points] > problem.threshold]
        if not points.size:
            break
        begin = start(growth.multipliers[points], _nearer_extreme(problem, points))
        growth.attempt(points, begin, NOT_FITTED, max_passes=MAX_PASSES)
        fixed = int((growth.distance[points] <= problem.threshold).sum())
        done.append(Improvement(name, len(points), fixed))
    return tuple(done)


def _nearer_extreme(problem: Problem, points: Indices) -> Array:
    """Multipliers (k, C) of a linear part of +1 for goals nearer to white, −1 for those nearer to black."""
    sign = np.where(problem.goal(points).mean(axis=1) >= 0.5, 1.0, -1.0)
    return sign[:, None] * problem.model.constant()
