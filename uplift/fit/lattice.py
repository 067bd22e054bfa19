"""Fit the points of a lattice: growth, improvement and storage, and the status of every point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.fit.grow import grow_from_prior, supporting_points
from uplift.fit.grow_from_neighbours import grow_from_neighbours
from uplift.fit.growth import Growth, PointPrior
from uplift.fit.improve import STEPS, THESIS_STEPS, Improvement, Start, improve
from uplift.fit.problem import Problem
from uplift.fit.starts import Starts
from uplift.fit.store import store
from uplift.lattice import NO_ENTRY, NOT_FITTED, Lattice, PointTable, Status


@dataclass(frozen=True, eq=False)
class LatticeFit:
    """The result of `fit_lattice`.

    Parameters
    ----------
    points : PointTable
        The fitted points.
    improvements : tuple of Improvement
        Steps of the improvement pass that were needed.
    solver_steps : int
        Steps of the solver over all points.
    """

    points: PointTable
    improvements: tuple[Improvement, ...]
    solver_steps: int


Grow = Callable[[Problem, PointPrior, Indices, ProgressCallback], Growth]


@dataclass(frozen=True)
class Strategy:
    """How the points of a lattice are fitted.

    Parameters
    ----------
    grow : callable
        From problem, prior, seeds and progress to the growth.
    improvements : mapping
        Steps of the improvement pass.
    supporting_points : callable
        From lattice and points to these points and the others that must be fitted for the same answers.
    """

    grow: Grow
    improvements: Mapping[str, Start]
    supporting_points: Callable[[Lattice, Indices], Indices]


def _whole_lattice(lattice: Lattice, points: Indices) -> Indices:
    return np.arange(lattice.size)


FROM_PRIOR = Strategy(grow_from_prior, STEPS, supporting_points)
STRATEGIES = {
    "prior": FROM_PRIOR,
    "neighbours": Strategy(grow_from_neighbours, THESIS_STEPS, _whole_lattice),
}
"""Strategies by the name of what points start from. ``"neighbours"`` is the algorithm of Tódová 2020, section 3.1."""


def fit_lattice(
    problem: Problem,
    starts: Starts,
    progress: ProgressCallback = ignore_progress,
    strategy: Strategy = FROM_PRIOR,
) -> LatticeFit:
    """Fit the active points of a problem.

    RGB, distance and status are computed from the stored coefficients. Unrealisable points are fitted to the nearest
    realisable colour; their distance is measured from the unrealisable one.

    Parameters
    ----------
    problem : Problem
        Model, lattice and threshold.
    starts : Starts
        What points start from, and the standard errors.
    progress : callable, optional
        Called with `Progress` events of the stages ``"fit"`` and ``"store"``.
    strategy : Strategy, default `FROM_PRIOR`
        Growth and improvement.

    Returns
    -------
    LatticeFit
        The table of points, and the steps of the improvement pass.
    """
    seeds = starts.seeds
    entry = np.full(problem.lattice.size, NO_ENTRY, dtype=np.int32)
    entry[seeds.points] = seeds.entry

    def expected(points: Indices) -> Array:
        return starts(points, problem.goal(points))

    grown = strategy.grow(problem, expected, seeds.points, progress)
    improvements = improve(grown, strategy.improvements)
    stored = store(grown)
    status = np.full(problem.lattice.size, Status.REGULAR, dtype=np.uint8)
    status[seeds.points] = np.where(seeds.primary, Status.ATLAS_PRIMARY, Status.ATLAS_CORNER)
    status[grown.round == NOT_FITTED] = Status.IMPROVED
    outside = problem.unrealisable.points
    status[outside] = Status.UNREALISABLE
    status[stored.distance > problem.threshold] = Status.UNFITTED
    stored.distance[outside] = np.abs(problem.lattice.target(outside) - stored.rgb[outside]).max(axis=1)
    status[outside[stored.distance[outside] <= problem.threshold]] = Status.REGULAR
    absent = problem.absent
    status[absent], entry[absent] = Status.ABSENT, NO_ENTRY
    errors = starts.prior.standard_errors(problem)
    points = PointTable(stored.coefficients, stored.rgb, stored.distance, status, entry, grown.round, errors)
    return LatticeFit(points, improvements, grown.steps)
