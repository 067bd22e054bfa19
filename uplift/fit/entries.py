"""Fit atlas entries by the spectrum model: exact colour, close spectrum and colours under other lights.

docs/mathematics.md, 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.least_change import nearest_of_colour
from uplift.fit.objective import BALANCED, Objective, Weights, objective
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap

if TYPE_CHECKING:
    from uplift.fit.stock_solver import Solver

MAX_STEPS = 256
PRECISION = 1e-8
"""Relative reduction of the objective, change of the multipliers and steepness at which MINPACK stops."""


@dataclass(frozen=True, eq=False, repr=False)
class FittedEntries:
    """Atlas entries as spectra of the model.

    Parameters
    ----------
    rgb : ndarray, shape (E, 3)
        Linear RGB.
    measured : ndarray, shape (E, N)
        Measured reflectances at the wavelengths of the sensor.
    multipliers : ndarray, shape (E, C)
        Multipliers of the fitted spectra.
    error : ndarray, shape (E,)
        ΔE00 between measured and fitted spectrum.
    """

    rgb: Array
    measured: Array
    multipliers: Array
    error: Array

    def __len__(self) -> int:
        return len(self.rgb)

    def __repr__(self) -> str:
        return f"FittedEntries({len(self)} entries, {self.multipliers.shape[-1]} multipliers each)"


def fit_entries(
    model: Model,
    forward: ForwardMap,
    measured: Array,
    rgb: Array,
    lights: Sequence[Light],
    error_light: Light,
    tolerance: float,
    weights: Weights = BALANCED,
    solver: Solver | None = None,
) -> FittedEntries:
    """Fit measured reflectances by the spectrum model.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to the RGB of the sensor.
    measured : ndarray, shape (E, N)
        Reflectances at the wavelengths of ``forward``.
    rgb : ndarray, shape (E, 3)
        Linear RGB of the entries, met to ``tolerance``.
    lights : sequence of Light
        Lights under which the colours of the entries should be kept.
    error_light : Light
        Light of `FittedEntries.error`.
    tolerance : float
        Largest residual in linear RGB.
    weights : Weights, optional
        Weights of the terms of the objective.
    solver : optimistix.AbstractLeastSquaresSolver, optional
        Solver of the objective. MINPACK by default, which is faster at every number of entries: a batch of entries
        runs until its last one converges (docs/performance.md).

    Returns
    -------
    FittedEntries
        Multipliers and errors.
    """
    goal = objective(model, forward.basis, lights, weights)
    start = _by_minpack(goal, measured) if solver is None else _by_solver(solver, goal, measured)
    multipliers = nearest_of_colour(model, forward, start, rgb, tolerance, MAX_STEPS)
    spectra = np.asarray(model.squash(multipliers @ forward.basis.T))
    return FittedEntries(rgb, measured, multipliers, delta_e_spectra(error_light, spectra, measured))


def _by_solver(solver: Solver, goal: Objective, measured: Array) -> Array:
    """Do the same as `_by_minpack` by a solver of optimistix."""
    from uplift.fit.stock_solver import solve_objective

    return solve_objective(solver, goal, measured)


def _by_minpack(goal: Objective, measured: Array) -> Array:
    """Multipliers (E, C) that minimise the objective of measured reflectances (E, N)."""
    from scipy.optimize import leastsq

    multipliers, scale = np.zeros((len(measured), goal.model.count)), np.ones(goal.model.count)
    for row, spectrum in enumerate(measured):
        multipliers[row], *_ = leastsq(
            goal.residuals_from,
            multipliers[row],
            args=(spectrum, goal.colours(spectrum)),
            Dfun=lambda p, *_: goal.jacobian(p),
            full_output=True,  # otherwise it warns where rounding ends the fit
            ftol=PRECISION,
            xtol=PRECISION,
            gtol=PRECISION,
            diag=scale,
        )
    return multipliers
