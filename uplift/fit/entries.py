"""Fit of atlas entries: the measured spectrum, its colours under several lights, and exactly its RGB.

docs/mathematics.md, 6. The objective is minimised by Levenberg and Marquardt's method in MINPACK, which is faster than
a batch on JAX at every number of entries: a batch runs until its last entry converges (docs/performance.md).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra, lab_jacobian, lab_of
from uplift.common.arrays import Array
from uplift.fit.problem import Problem
from uplift.fit.solver import solve_singly
from uplift.models.model import Model

LIGHTS_WEIGHT, SMOOTHNESS = 0.03, 1e-3
"""Weights of a unit of CIE L*a*b* under a light, and of the multipliers but the constant one, in the metric M of
docs/mathematics.md, 5, relative to the root-mean-square difference of the spectra (docs/fidelity.md).

Without smoothness the minimum of a dark entry jumps: of two spectra that meet its colours nearly equally well one has
multipliers ten times as large, and noise decides between them.
"""
ENDS = 8
"""Each end of the spectrum is this part of it: 50 nm of 380–780."""
FLATNESS = 1e-5
"""Weight that keeps the constant multiplier finite where neither the spectrum nor the lights constrain it."""
MAX_STEPS = 256
PRECISION = 1e-8
"""Relative reduction of the objective, change of the multipliers and steepness at which MINPACK stops."""


@dataclass(frozen=True, eq=False)
class Objective:
    """Residuals of the fit of a measured reflectance (N,), and their derivative.

    ``values`` (N,) weighs a difference of spectra, ``weight`` a unit of CIE L*a*b*, ``multipliers`` (C,) the
    multipliers. ``lights`` (L, 3, N) maps spectra to XYZ, and ``whites`` (L, 3) are those of the perfect reflector.
    """

    model: Model
    basis: Array
    values: Array
    lights: Array
    whites: Array
    weight: float
    multipliers: Array

    def colours(self, spectrum: Any) -> Any:
        """CIE L*a*b* (L, 3) of a spectrum (N,) under the lights."""
        return lab_of(self.lights @ spectrum, self.whites)

    def residuals(self, multipliers: Any, measured: Any, colours: Any) -> Any:
        """Residuals (N + 3 L + C,) for a measurement (N,) with its `colours`; all of numpy or of JAX."""
        spectrum = self.model.to_reflectance(self.basis @ multipliers)
        difference, colour_difference = spectrum - measured, self.colours(spectrum) - colours
        return multipliers.__array_namespace__().concat(
            [
                self.values * difference,
                self.weight * colour_difference.ravel(),
                self.multipliers * multipliers,
            ]
        )

    def jacobian(self, multipliers: Array) -> Array:
        """Derivative (N + 3 L + C, C) of the residuals; it does not depend on the measurement."""
        x = self.basis @ multipliers
        change = self.model.derivative(x)[:, None] * self.basis  # g = S(B p), so ∂g/∂p = S′(B p) B
        to_lab = lab_jacobian(self.lights @ self.model.to_reflectance(x), self.whites)
        colours = (to_lab @ (self.lights @ change)).reshape(-1, len(multipliers))
        return np.concatenate(
            [
                self.values[:, None] * change,
                self.weight * colours,
                np.diag(self.multipliers),
            ]
        )

    def steepness(self, multipliers: Array, measured: Array) -> float:
        """Largest cosine of the angle between the residuals and their derivatives: 0 at a minimum, NaN without one."""
        slopes, residuals = self.jacobian(multipliers), self.residuals(multipliers, measured, self.colours(measured))
        norms = np.linalg.norm(slopes, axis=0) * np.linalg.norm(residuals)
        return float(np.abs(slopes.T @ residuals / norms).max())


def objective(
    problem: Problem, lights: float = LIGHTS_WEIGHT, ends: float = 1.0, smoothness: float = SMOOTHNESS
) -> Objective:
    """Make the objective of entries; the squared weights of values sum to a weighted mean square.

    ``ends`` is the weight of the two ends of the spectrum relative to its middle.
    """
    model, count = problem.model, len(problem.forward.basis)
    importance = np.ones(count)
    importance[: count // ENDS] = importance[-(count // ENDS) :] = ends
    # M = diag(1 + j²), but the constant multiplier is left to the measurement.
    smooth = np.maximum(smoothness * np.sqrt(model.metric_diagonal()), FLATNESS)
    return Objective(
        model,
        problem.forward.basis,
        np.sqrt(importance / importance.sum()),
        np.stack([light.xyz for light in problem.lights]),
        np.stack([light.white for light in problem.lights]),
        lights,
        np.where(model.constant() > 0, FLATNESS, smooth),
    )


class FittedEntries(NamedTuple):
    """E atlas entries as spectra of the model.

    Linear ``rgb`` (E, 3), ``measured`` reflectances (E, N) at the wavelengths of the sensor, ``multipliers`` (E, C) of
    the fitted spectra, and the ``error`` (E,): ΔE00 between both.
    """

    rgb: Array
    measured: Array
    multipliers: Array
    error: Array

    def rows(self, rows: Any) -> FittedEntries:
        """Return some of the entries."""
        return FittedEntries(*(column[rows] for column in self))


def fit_entries(problem: Problem, measured: Array, rgb: Array, **weights: float) -> FittedEntries:
    """Fit measured reflectances (E, N) by the spectrum model, and meet their linear RGB (E, 3) to the tolerance.

    ``weights`` are those of `objective`, min ‖g − m‖² + Σ |w ΔL*a*b*|².
    """
    goal = objective(problem, **weights)
    if problem.solver is None:
        from scipy.optimize import leastsq

        # From grey, by Levenberg and Marquardt's method
        near, scale = np.zeros((len(measured), goal.model.count)), np.ones(goal.model.count)
        for row, spectrum in enumerate(measured):
            near[row], *_ = leastsq(
                goal.residuals,
                near[row],
                args=(spectrum, goal.colours(spectrum)),
                Dfun=lambda p, *_: goal.jacobian(p),
                full_output=True,  # otherwise it warns where rounding ends the fit
                ftol=PRECISION,
                xtol=PRECISION,
                gtol=PRECISION,
                diag=scale,
            )
    else:
        from uplift.fit.optimistix_solvers import minimise  # the default needs no optimistix

        near = minimise(problem.solver, goal, measured)
    # The minimum has nearly the colour; of all spectra that have it exactly, the nearest to the minimum is taken.
    multipliers = solve_singly(problem.forward, near, rgb, problem.tolerance, MAX_STEPS)
    spectra = np.asarray(problem.model.to_reflectance(multipliers @ problem.forward.basis.T))
    return FittedEntries(
        rgb, measured, multipliers, delta_e_spectra(problem.error_light or problem.sensor.light, spectra, measured)
    )


def join_entries(*parts: FittedEntries) -> FittedEntries:
    """Put entries after one another."""
    return FittedEntries(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
