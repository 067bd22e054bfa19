"""Sigmoid (SG) of Jakob & Hanika 2019: three coefficients per reflectance (`uplift.models.sigmoid`).

The coefficients are fitted by the Levenberg–Marquardt method to the colour of the reflectance under D65. Its values at
5 nm, with a small weight, determine the fit where the colour does not or cannot be met.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.common.arrays import Array
from uplift.models import Sigmoid
from uplift.models.model import evaluate
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.table import TabulatedProducts

SHAPE_WEIGHT = 1e-4
"""Weight of the residual at one wavelength relative to that of the colour."""
ITERATIONS = 20
FIRST_DAMPING, INCREASE, DECREASE = 1e-3, 10.0, 0.3
"""Damping of the first iteration, and its factors after a rejected and after an accepted step."""


@dataclass(frozen=True)
class SigmoidCoefficients(TabulatedProducts):
    """Three coefficients."""

    model: Sigmoid = field(default_factory=Sigmoid)
    name = "SG3"
    family = "sigmoid"

    def encode_surface(self, reflectance: Array) -> Array:
        return fit_sigmoids(self.model, reflectance[:, ::TABLE_STRIDE])


def fit_sigmoids(model: Sigmoid, table: Array) -> Array:
    """Fit coefficients (n, 3) to reflectances (n, 81)."""
    light, basis = observer.light(DEFAULT_ILLUMINANT), model.basis(observer.grid())
    measurement = np.concatenate([light.xyz / light.white[:, None], SHAPE_WEIGHT * np.eye(len(basis))])

    def residuals(coefficients: Array) -> Array:
        return (evaluate(model, coefficients, observer.grid()) - table) @ measurement.T

    coefficients = np.zeros((len(table), model.count))
    damping = np.full((len(table), 1, 1), FIRST_DAMPING)
    residual = residuals(coefficients)
    for _ in range(ITERATIONS):
        jacobian = measurement @ (model.slope(coefficients @ basis.T)[:, :, None] * basis)
        gram = jacobian.mT @ jacobian
        scale = damping * np.einsum("nii->ni", gram)[:, :, None] * np.eye(model.count)
        trial = coefficients - np.linalg.solve(gram + scale, jacobian.mT @ residual[:, :, None])[:, :, 0]
        trial_residual = residuals(trial)
        accepted = (trial_residual**2).sum(axis=1) < (residual**2).sum(axis=1)
        coefficients[accepted], residual[accepted] = trial[accepted], trial_residual[accepted]
        damping *= np.where(accepted, DECREASE, INCREASE)[:, None, None]
    return coefficients
