"""scipy's ``least_squares``, one node at a time."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import version

import numpy as np
from scipy.optimize import least_squares

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge_multipliers
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.models import Moments

COUNT = 9
POINTS = 32
OUTSIDE = 1.0
"""Residual of numbers that are not the moments of any reflectance, larger than that of any colour."""


def scipy_least_squares(runs: int) -> list[Peer]:
    """Time the fit of multipliers with the exact Jacobian, and of moments with numeric differences."""
    model, sensor, target = Moments(COUNT), task.sensor(), task.some(POINTS)
    basis, weights = model.basis(sensor.wavelengths), sensor.matrix

    def residual(multipliers: Array, rgb: Array) -> Array:
        return weights @ model.squash(basis @ multipliers) - rgb

    def jacobian(multipliers: Array, rgb: Array) -> Array:
        return (weights * model.slope(basis @ multipliers)) @ basis

    def residual_of_moments(moments: Array, rgb: Array) -> Array:
        try:
            return residual(model.from_storage(moments), rgb)
        except UpliftError:
            return np.full(3, OUTSIDE)

    def by_multipliers() -> Array:
        return _each(lambda rgb: least_squares(residual, np.zeros(COUNT), jacobian, args=(rgb,)).x, target)

    def by_moments() -> Array:
        grey = model.to_storage(np.zeros(COUNT))
        return _each(lambda rgb: least_squares(residual_of_moments, grey, args=(rgb,)).x, target)

    def row(solve: Callable[[], Array], stored: bool, least: float, notes: str) -> Peer:
        solution, cpu = task.measured(solve, POINTS, runs)
        multipliers = model.from_storage(solution) if stored else solution
        answer = judge_multipliers(model, multipliers, sensor, target, least=least)
        tool = f"scipy {version('scipy')} `least_squares`"
        return Peer(tool, "moments", COUNT, POINTS, cpu, answer, notes)

    return [
        row(by_multipliers, False, 0.95, "in p, exact Jacobian; every point from grey"),
        row(by_moments, True, 0.5, "in c, numeric differences; every point from grey"),
    ]


def _each(solve: Callable[[Array], Array], target: Array) -> Array:
    return np.stack([solve(rgb) for rgb in target])
