"""Search among the candidates of a plan: the Pareto front by branch and bound, and the
cheapest candidates within a tolerance.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import compress
from operator import attrgetter

import numpy as np

from uplift.common.arrays import Array, Mask
from uplift.extras.scene.plan.candidates import Candidate
from uplift.extras.scene.plan.files import CostName, Minimised
from uplift.pipeline.options import Options

Measure = Callable[[Options | None, Sequence[Candidate]], list[Candidate]]
"""Builds the cube that candidates share, and measures their errors."""


def explore(
    candidates: Iterable[Candidate], measure: Measure, floor: float
) -> list[Candidate]:
    """Measure the candidates that may be on the Pareto front, by branch and bound,
    cubes of few bytes first.

    Candidates that share a cube are measured together, as they cost one build. One is
    left out if a measured one dominates it: no cost is larger, and its error is at most
    the lower bound of the other's. Errors below the ``floor`` count as equal. If every
    bound holds, none that is left out costs less than the cheapest measured one of its
    error.
    """
    groups: dict[Options | None, list[Candidate]] = defaultdict(list)
    for candidate in candidates:
        groups[candidate.cube].append(candidate)
    measured = list[Candidate]()
    best = np.empty((0, 4))

    def smallest(cube: Options | None) -> float:
        return min(candidate.cost.memory for candidate in groups[cube])

    for cube in sorted(groups, key=smallest):
        group = groups[cube]
        rows = np.array(
            [(*candidate.cost, max(candidate.bound, floor)) for candidate in group]
        )
        promising = list(compress(group, ~dominated(rows, best)))
        if promising:
            measured += measure(cube, promising)
            best = positions(pareto_front(measured), floor)
    return measured


def dominated(rows: Array, by: Array) -> Mask:
    """Rows (m, k) for which a row of ``by`` (f, k) is nowhere larger."""
    return np.asarray((by[:, None] <= rows).all(axis=2).any(axis=0))


def front(rows: Array) -> list[int]:
    """Numbers of the rows (m, k) that no other dominates, smallest rows first; of equal
    rows the first.
    """
    kept = list[int]()
    # what dominates a row comes before it
    for row in np.lexsort(rows.T[::-1]).tolist():
        if not dominated(rows[[row]], rows[kept])[0]:
            kept.append(row)
    return kept


def positions(measured: Sequence[Candidate], floor: float = 0.0) -> Array:
    """Costs and errors (m, 4) of candidates."""
    rows = [
        (*candidate.cost, max(candidate.error.quantile, floor))
        for candidate in measured
    ]
    return np.array(rows).reshape(-1, 4)


def pareto_front(measured: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that no other dominates in cost and error, by ascending error; one of
    equal ones.
    """
    rows = front(positions(measured))
    return sorted(map(measured.__getitem__, rows), key=attrgetter("error.quantile"))


def cheapest_first(
    measured: Iterable[Candidate], minimise: Minimised
) -> list[Candidate]:
    """Candidates by cost, then by error."""
    return sorted(
        measured,
        key=lambda candidate: (
            candidate.cost.ranked(minimise),
            candidate.error.quantile,
        ),
    )


def sufficient(
    measured: Iterable[Candidate],
    tolerance: float,
    minimise: Minimised,
    limits: Mapping[CostName, float],
) -> list[Candidate]:
    """Candidates within the tolerance and the limits of costs, cheapest first."""
    accurate = (each for each in measured if each.error.quantile <= tolerance)
    return [
        candidate
        for candidate in cheapest_first(accurate, minimise)
        if not over_limits(candidate, limits)
    ]


def over_limits(candidate: Candidate, limits: Mapping[CostName, float]) -> list[str]:
    """Names of the costs that are above a limit."""
    costs = candidate.cost._asdict()
    return [name for name, limit in limits.items() if costs[name] > limit]
