"""The moments model: bounded maximum-entropy spectra, stored as mirrored trigonometric moments.

Peters et al. 2019 (`uplift.models.duality`). g(φ) = ½ + arctan(p₀ + 2 Σ p_l cos lφ) / π: every real p is a
valid spectrum, so the fit works on p; c is linear in the spectrum, so that is what cubes store.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.models import duality
from uplift.models.arctan import arctan, arctan_difference
from uplift.models.duality import Quadrature
from uplift.models.phase import Phase

FEWEST, MOST = 3, 17
"""Coefficients: 2 to 16 moments, and the zeroth."""


@dataclass(frozen=True)
class Moments:
    """``count`` coefficients (moments + 1) over a `Phase`."""

    count: int = 9
    phase: Phase = field(default_factory=Phase)
    name = "moments"

    def __post_init__(self) -> None:
        if not FEWEST <= self.count <= MOST:
            raise OptionError(
                f"{self.count} coefficients are out of range",
                hint=f"the moments model takes {FEWEST} to {MOST} (moments + 1)",
            )

    def basis(self, wavelengths: ArrayLike) -> Array:
        return duality.cosine_basis(self.phase(wavelengths), self.count)

    def squash(self, x: Any) -> Any:
        return 0.5 + arctan(x) / np.pi

    def slope(self, x: Any) -> Any:
        return 1 / (np.pi * (1 + x * x))

    def squash_difference(self, x: Array, change: Array) -> Array:
        return arctan_difference(x, change) / np.pi

    def unsquash(self, reflectance: Array) -> Array:
        return np.tan(np.pi * (reflectance - 0.5))

    def constant(self) -> Array:
        return np.eye(self.count)[0]

    def roughness(self) -> Array:
        """1 + j²: what a unit of p_j adds to the squares of the value and the slope over φ."""
        return 1 + np.arange(self.count, dtype=float) ** 2

    def to_storage(self, multipliers: ArrayLike, quadrature: Quadrature = duality.quadrature) -> Array:
        return _by_rows(partial(duality.moments_from_multipliers, quadrature=quadrature), multipliers)

    def from_storage(self, coefficients: ArrayLike) -> Array:
        return _by_rows(duality.multipliers_from_moments, coefficients)

    def describe(self) -> dict[str, Any]:
        return {"name": self.name, "count": self.count, "phase": asdict(self.phase)}


def _by_rows(function: Any, values: ArrayLike) -> Array:
    array = np.asarray(values, dtype=float)
    return np.reshape(function(array.reshape(-1, array.shape[-1])), array.shape)
