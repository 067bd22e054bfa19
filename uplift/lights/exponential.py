"""The exponential model: positive spectra without an upper bound, for lights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models.model import Model


@dataclass(frozen=True)
class Exponential(Model):
    """Spectra g(λ) = exp(Σ p_j cos(j π t)), where t runs from 0 to 1 over the range.

    The multipliers are stored unchanged. With as many of them as there are evenly spaced wavelengths, every positive
    spectrum is one of the model. Outside [start, end] the spectrum is constant.

    Parameters
    ----------
    count : int, default 81
        Number of multipliers.
    start, end : float
        Range in nm.
    """

    count: int = 81
    start: float = 380.0
    end: float = 780.0
    name = "exponential"

    def basis(self, wavelengths: ArrayLike) -> Array:
        t = (np.clip(wavelengths, self.start, self.end) - self.start) / (self.end - self.start)
        return np.asarray(np.cos(np.pi * np.arange(self.count) * t[..., None]))

    def to_reflectance(self, x: Any) -> Any:
        return x.__array_namespace__().exp(x)

    def derivative(self, x: Any) -> Any:
        return self.to_reflectance(x)

    def from_reflectance(self, reflectance: Array) -> Array:
        return np.log(reflectance)

    def constant(self) -> Array:
        return np.eye(self.count)[0]

    def metric_diagonal(self) -> Array:
        return np.asarray(1.0 + np.arange(self.count) ** 2)
