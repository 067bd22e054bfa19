"""Branch and bound over candidates: the Pareto front of their costs and errors, and the cheapest sufficient one.

Candidates that share a cube are measured together, as they cost one build. A candidate is left out if a measured one
dominates it: no cost is larger, and its error is at most the lower bound of the other's.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Mask
from uplift.scene.plan.candidates import Candidate, Cost, CubeChoice, Measured


class Estimate(NamedTuple):
    """A candidate that is not measured yet: its costs, and a lower bound of its ΔE00."""

    candidate: Candidate
    cost: Cost
    bound: float


Measure = Callable[[CubeChoice | None, Sequence[Estimate]], list[Measured]]
"""Builds the cube that candidates share, and measures them."""


def explore(estimates: Iterable[Estimate], measure: Measure, floor: float) -> list[Measured]:
    """Measure the candidates that may be on the Pareto front, cubes of few bytes first.

    Errors below the ``floor`` count as equal. If every bound holds, no candidate that is left out costs less than the
    cheapest measured one of the same error.
    """
    groups: dict[CubeChoice | None, list[Estimate]] = defaultdict(list)
    for estimate in estimates:
        groups[estimate.candidate.cube].append(estimate)
    measured, best = list[Measured](), np.empty((0, 4))
    for cube in sorted(groups, key=lambda cube: min(each.cost.memory for each in groups[cube])):
        rows = np.array([(*each.cost, max(each.bound, floor)) for each in groups[cube]])
        promising = [groups[cube][row] for row in np.flatnonzero(~dominated(rows, best))]
        if promising:
            measured += measure(cube, promising)
            best = positions(pareto_front(measured), floor)
    return measured


def dominated(rows: Array, by: Array) -> Mask:
    """Rows (m, k) for which a row of ``by`` (f, k) is nowhere larger."""
    return np.asarray((by[:, None] <= rows).all(axis=2).any(axis=0))


def front(rows: Array) -> list[int]:
    """Numbers of the rows (m, k) that no other dominates, smallest rows first; of equal rows the first."""
    kept: list[int] = []
    for row in np.lexsort(rows.T[::-1]).tolist():  # what dominates a row comes before it
        if not dominated(rows[[row]], rows[kept])[0]:
            kept.append(row)
    return kept


def positions(measured: Sequence[Measured], floor: float = 0.0) -> Array:
    """Costs and errors (m, 4) of candidates."""
    return np.array([(*each.cost, max(each.error.quantile, floor)) for each in measured]).reshape(-1, 4)


def pareto_front(measured: Sequence[Measured]) -> list[Measured]:
    """Candidates that no other dominates in cost and error, by ascending error; one of equal ones."""
    return sorted((measured[row] for row in front(positions(measured))), key=lambda each: each.error.quantile)


def sufficient(
    measured: Iterable[Measured], tolerance: float, minimise: str, limits: Mapping[str, float]
) -> list[Measured]:
    """Candidates within the tolerance and the limits of costs, cheapest first."""
    found = [
        each
        for each in measured
        if each.error.quantile <= tolerance and all(getattr(each.cost, key) <= limits[key] for key in limits)
    ]
    return sorted(found, key=lambda each: (each.cost.ranked(minimise), each.error.quantile))
