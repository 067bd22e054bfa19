"""The sigmoid model: a sigmoid of a quadratic polynomial of the wavelength, three
coefficients per spectrum.

References
----------
Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral
upsampling", CGF 38(2), eq. 5.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Mask
from uplift.models.model import Model

MAX_SAFE_LINEAR = 1.0
"""Bound of the linear part up to which single precision keeps colours
(tests/models/test_models.py).
"""
LEAST = 1e-30
"""Lower limit of 1 − 4 (ρ − ½)² of a reflectance ρ, so that the linear parts of 0 and 1
are finite.
"""


@dataclass(frozen=True)
class Sigmoid(Model):
    """Spectra g(x) = S(c₀x² + c₁x + c₂) with S(t) = ½ + t / (2√(1 + t²)).

    x is the wavelength scaled from [start, end] nm to [−1, 1], which gives the
    coefficients similar magnitudes. The multipliers are stored unchanged. Outside
    [start, end] the spectrum is constant, as no data constrain it there.

    Parameters
    ----------
    start, end : float
        Range in nm.

    References
    ----------
    Jakob & Hanika 2019, eq. 5.
    """

    start: float = 380.0
    end: float = 780.0
    name = "sigmoid"
    count = 3

    def basis(self, wavelengths: ArrayLike) -> Array:
        middle = (self.start + self.end) / 2
        half = (self.end - self.start) / 2
        x = (np.clip(wavelengths, self.start, self.end) - middle) / half
        return np.stack([x * x, x, np.ones_like(x)], axis=-1)

    def to_reflectance(self, x: Any) -> Any:
        # S(t) = ½ + t / (2√(1 + t²)): Jakob & Hanika 2019, eq. 5
        return 0.5 + x / (2 * (1 + x * x) ** 0.5)

    def derivative(self, x: Any) -> Any:
        # S′(t) = ½ (1 + t²)^(−3/2)
        square = 1 + x * x
        return 0.5 / (square * square**0.5)  # powers other than roots are slow

    def from_reflectance(self, reflectance: Any) -> Any:
        half = reflectance - 0.5
        xp = reflectance.__array_namespace__()
        return 2 * half / xp.sqrt(xp.maximum(1 - 4 * half * half, LEAST))

    def constant(self) -> Array:
        return np.eye(self.count)[-1]

    def metric_diagonal(self) -> Array:
        return np.ones(self.count)

    def is_float32_safe(self, multipliers: Array) -> Mask:
        return np.abs(multipliers).sum(axis=1) <= MAX_SAFE_LINEAR


def evaluate_unscaled(coefficients: Array, wavelengths: Array) -> Array:
    """Evaluate eq. 5 of Jakob & Hanika 2019 for coefficients (n, 3), at wavelengths
    (N,) in nm that are not scaled.
    """
    x = coefficients @ np.stack(
        [wavelengths**2, wavelengths, np.ones_like(wavelengths)]
    )
    return 0.5 + x / (2 * np.sqrt(1 + x * x))


def unscaled(model: Sigmoid, multipliers: Array) -> Array:
    """Convert multipliers (n, 3) to the coefficients of `evaluate_unscaled`."""
    middle = (model.start + model.end) / 2
    half = (model.end - model.start) / 2
    square, linear, constant = (multipliers / half ** np.array([2, 1, 0])).T
    return np.column_stack(
        [
            square,
            linear - 2 * middle * square,
            constant + middle * (middle * square - linear),
        ]
    )
