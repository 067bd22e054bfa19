"""Fit of atlas entries: the measured spectrum, its colours under several lights, and
exactly its RGB.

docs/mathematics.md, 6.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra, lab, lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices
from uplift.fit.problem import Problem
from uplift.fit.solver import solve_in_numpy
from uplift.models.least_squares import least_squares
from uplift.models.model import Model

LIGHTS_WEIGHT = 0.03
"""Weight of a unit of CIE L*a*b* under a light, relative to the root-mean-square
difference of the spectra.
"""
SMOOTHNESS = 1e-3
"""Weight, likewise, of the multipliers but the constant one, in the metric M of
docs/mathematics.md, 5.

Without smoothness the minimum of a dark entry jumps: of two spectra that meet its
colours nearly equally well one has multipliers ten times as large, and noise decides
between them.
"""
FLATNESS = 1e-5
"""Weight that keeps the constant multiplier finite where neither the spectrum nor the
lights constrain it.
"""
MAX_STEPS = 256


@dataclass(frozen=True, eq=False)
class Objective:
    """Residuals of the fit of a measured reflectance (N,), and their normal equations.

    ``values`` weighs a difference of spectra, ``weight`` a unit of CIE L*a*b*,
    ``multipliers`` (C,) the multipliers. ``lights`` (L, 3, N) maps spectra to XYZ, and
    ``whites`` (L, 3) are those of the perfect reflector.
    """

    model: Model
    basis: Array
    values: float
    lights: Array
    whites: Array
    weight: float
    multipliers: Array

    @cached_property
    def basis_products(self) -> Array:
        """B_kj B_kl (N, C²)."""
        return np.einsum("kj,kl->kjl", self.basis, self.basis).reshape(
            len(self.basis), -1
        )

    @cached_property
    def light_basis(self) -> Array:
        """Products (N, 3 L · C) of the rows of the lights with the basis."""
        rows = self.lights.reshape(-1, len(self.basis))
        return np.einsum("rk,kj->krj", rows, self.basis).reshape(len(self.basis), -1)

    def xyz(self, spectra: Array) -> Array:
        """XYZ (…, L, 3) of spectra (…, N) under the lights."""
        rows = self.lights.reshape(-1, len(self.basis))
        return (spectra @ rows.T).reshape(*spectra.shape[:-1], *self.lights.shape[:2])

    def colours(self, spectra: Array) -> Array:
        """CIE L*a*b* (…, L, 3) of spectra (…, N) under the lights."""
        return lab(self.xyz(spectra), self.whites)

    def residuals(self, multipliers: Array, measured: Array, colours: Array) -> Array:
        """Residuals (…, N + 3 L + C) for measurements (…, N) with their `colours`."""
        spectra = self.model.to_reflectance(multipliers @ self.basis.T)
        colour_difference = self.colours(spectra) - colours
        return np.concatenate(
            [
                self.values * (spectra - measured),
                self.weight * colour_difference.reshape(*measured.shape[:-1], -1),
                self.multipliers * multipliers,
            ],
            axis=-1,
        )

    def normal_equations(
        self, multipliers: Array, residuals: Array
    ) -> tuple[Array, Array]:
        """JᵀJ (n, C, C) and Jᵀf (n, C) of residuals f (n, N + 3 L + C), J = ∂f/∂p, at
        multipliers p (n, C).

        J itself, which has a row for each residual, is not formed.
        """
        x = multipliers @ self.basis.T
        shape = (*multipliers.shape, multipliers.shape[1])
        ends = [len(self.basis), residuals.shape[1] - shape[1]]
        spectra, lights, smoothness = np.split(residuals, ends, axis=1)
        # g = S(B p), so ∂g/∂p = S′(B p) B, and ∂XYZ/∂p = M ∂g/∂p of each light
        change = self.model.derivative(x)
        xyz_change = (change @ self.light_basis).reshape(
            len(x), *self.lights.shape[:2], -1
        )
        colours = (
            lab_jacobian(self.xyz(self.model.to_reflectance(x)), self.whites)
            @ xyz_change
        )
        colours = self.weight * colours.reshape(len(x), -1, shape[1])
        gram = self.values**2 * (change**2 @ self.basis_products).reshape(shape)
        gram += colours.mT @ colours + np.diag(self.multipliers**2)
        slope = (
            self.values * (change * spectra) @ self.basis
            + (colours.mT @ lights[..., None])[..., 0]
        )
        return gram, slope + self.multipliers * smoothness


def objective(
    model: Model,
    basis: Array,
    lights: Sequence[Light],
    weight: float = LIGHTS_WEIGHT,
    smoothness: float | None = SMOOTHNESS,
) -> Objective:
    """Make the objective of spectra, whose mean square difference counts, and of their
    colours under lights.

    ``weight`` is that of a unit of CIE L*a*b*, ``smoothness`` that of the multipliers;
    None leaves them free.
    """
    xyz = np.stack([light.xyz for light in lights])
    whites = np.stack([light.white for light in lights])
    multipliers = np.zeros(model.count)
    if smoothness is not None:
        # M = diag(1 + j²), but the constant multiplier is left to the measurement.
        smooth = np.maximum(smoothness * np.sqrt(model.metric_diagonal()), FLATNESS)
        multipliers = np.where(model.constant() > 0, FLATNESS, smooth)
    return Objective(
        model,
        basis,
        values=float(np.sqrt(1 / len(basis))),
        lights=xyz,
        whites=whites,
        weight=weight,
        multipliers=multipliers,
    )


def minimise(goal: Objective, measured: Array) -> Array:
    """Multipliers (E, C) that minimise the objective of measured reflectances (E, N),
    starting from grey.
    """
    colours = goal.colours(measured)
    return least_squares(
        lambda y, rows: goal.residuals(y, measured[rows], colours[rows]),
        lambda y, values, _: goal.normal_equations(y, values),
        np.zeros((len(measured), goal.model.count)),
        max_steps=MAX_STEPS,
    )


class FittedEntries(NamedTuple):
    """E atlas entries as spectra of the model.

    Linear ``rgb`` (E, 3), ``measured`` reflectances (E, N) at the wavelengths of the
    sensor, ``multipliers`` (E, C) of the fitted spectra, and the ``error`` (E,): ΔE00
    between both.
    """

    rgb: Array
    measured: Array
    multipliers: Array
    error: Array

    def rows(self, rows: Any) -> "FittedEntries":
        """Return some of the entries."""
        return FittedEntries(*(column[rows] for column in self))


def fit_entries(
    problem: Problem, measured: Array, rgb: Array, **weights: float
) -> FittedEntries:
    """Fit measured reflectances (E, N) by the spectrum model, and meet their linear RGB
    (E, 3) to the tolerance.

    ``weights`` are the keyword arguments of `objective`. The order of the entries does
    not change the rounding of sums.
    """
    goal = objective(problem.model, problem.forward.basis, problem.lights, **weights)
    order = np.lexsort(rgb.T)
    measured = measured[order]
    rgb = rgb[order]
    near = minimise(goal, measured)
    # The minimum has nearly the colour; minimum-norm steps from there reach it.
    multipliers = solve_in_numpy(
        problem.forward, near, rgb, problem.tolerance, MAX_STEPS
    )
    error = _errors(problem, multipliers, measured)
    return FittedEntries(rgb, measured, multipliers, error).rows(np.argsort(order))


def _errors(problem: Problem, multipliers: Array, measured: Array) -> Array:
    """ΔE00 (E,) between fitted and measured spectra under the light of the errors."""
    spectra = problem.model.to_reflectance(multipliers @ problem.forward.basis.T)
    return delta_e_spectra(problem.light_of_errors, spectra, measured)


def with_multipliers(
    problem: Problem, entries: FittedEntries, rows: Indices, multipliers: Array
) -> FittedEntries:
    """Return entries of which rows (k,) have other multipliers, and errors of these."""
    changed = entries.multipliers.copy()
    changed[rows] = multipliers
    error = entries.error.copy()
    error[rows] = _errors(problem, multipliers, entries.measured[rows])
    return entries._replace(multipliers=changed, error=error)
