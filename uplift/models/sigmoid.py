"""The sigmoid model: a squashed quadratic of the wavelength, three numbers a spectrum.

Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", CGF 38(2), eq. 5.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models.duality import Quadrature, quadrature


@dataclass(frozen=True)
class Sigmoid:
    """g(x) = S(c₀x² + c₁x + c₂), S(t) = ½ + t / (2√(1 + t²)), x = λ taken from [start, end] nm to [−1, 1].

    The scaled wavelength keeps the coefficients alike in size. They are stored as they are. Outside [start, end]
    the spectrum is held flat: what the fit has not seen, the quadratic would make up.
    """

    start: float = 380.0
    end: float = 780.0
    name = "sigmoid"
    count = 3

    def basis(self, wavelengths: ArrayLike) -> Array:
        middle, half = (self.start + self.end) / 2, (self.end - self.start) / 2
        x = (np.clip(wavelengths, self.start, self.end) - middle) / half
        return np.stack([x * x, x, np.ones_like(x)], axis=-1)

    def squash(self, x: Any) -> Any:
        return 0.5 + x / (2 * (1 + x * x) ** 0.5)

    def slope(self, x: Any) -> Any:
        return 0.5 / (1 + x * x) ** 1.5

    def squash_difference(self, x: Array, change: Array) -> Array:
        return np.asarray(self.squash(x + change) - self.squash(x))

    def unsquash(self, reflectance: Array) -> Array:
        half = reflectance - 0.5
        return np.asarray(2 * half / np.sqrt(1 - 4 * half * half))

    def constant(self) -> Array:
        return np.eye(self.count)[-1]

    def roughness(self) -> Array:
        return np.ones(self.count)

    def to_storage(self, multipliers: ArrayLike, quadrature: Quadrature = quadrature) -> Array:
        return np.array(multipliers, dtype=float)

    def from_storage(self, coefficients: ArrayLike) -> Array:
        return np.array(coefficients, dtype=float)

    def describe(self) -> dict[str, Any]:
        return {"name": self.name, **asdict(self)}


def published(coefficients: Array, wavelengths: Array) -> Array:
    """Reflectances (n, N) by eq. 5 of Jakob & Hanika 2019: coefficients (n, 3) for wavelengths in nm, not scaled."""
    x = coefficients @ np.stack([wavelengths**2, wavelengths, np.ones_like(wavelengths)])
    return 0.5 + x / (2 * np.sqrt(1 + x * x))
