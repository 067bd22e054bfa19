"""Fit the points of a lattice: growth, improvement and storage, and the status of every point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.fit.grow import grow_from_prior
from uplift.fit.improve import Improvement, improve
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seed import Seeds
from uplift.fit.store import store
from uplift.lattice import NO_ENTRY, NOT_FITTED, PointTable, Status


@dataclass(frozen=True, eq=False)
class LatticeFit:
    """The result of `fit_lattice`.

    Parameters
    ----------
    points : PointTable
        The fitted points.
    improvements : tuple of Improvement
        Steps of the improvement pass that were needed.
    """

    points: PointTable
    improvements: tuple[Improvement, ...]


def fit_lattice(
    problem: Problem, seeds: Seeds, entries: Array, prior: Prior, progress: ProgressCallback = ignore_progress
) -> LatticeFit:
    """Fit the active points of a problem.

    Seeded points start from their entries, all others from the prior. RGB, distance and status are computed from
    the stored coefficients. Unrealisable points are fitted to the nearest realisable colour; their distance is
    measured from the unrealisable one.

    Parameters
    ----------
    problem : Problem
        Model, lattice and threshold.
    seeds : Seeds
        Points that start from atlas entries.
    entries : ndarray, shape (E, C)
        Multipliers of the atlas entries.
    prior : Prior
        Start of the other points, and the standard errors.
    progress : callable, optional
        Called with `Progress` events of the stages ``"fit"`` and ``"store"``.

    Returns
    -------
    LatticeFit
        The table of points, and the steps of the improvement pass.
    """
    entry = np.full(problem.lattice.size, NO_ENTRY, dtype=np.int32)
    entry[seeds.points] = seeds.entry

    def expected(points: Indices) -> Array:
        multipliers = prior(problem.goal(points))
        seeded = entry[points] != NO_ENTRY
        multipliers[seeded] = entries[entry[points[seeded]]]
        return multipliers

    grown = grow_from_prior(problem, expected, seeds.points, progress)
    improvements = improve(grown)
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
    errors = prior.standard_errors(problem)
    points = PointTable(stored.coefficients, stored.rgb, stored.distance, status, entry, grown.round, errors)
    return LatticeFit(points, improvements)
