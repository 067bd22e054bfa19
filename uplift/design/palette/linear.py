"""The linear model without sharpening's assumption: every reflection is an m × m matrix (Bergner, eq. 5–7)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.palette.factor import FactorModel


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Products in the span of a factor model's basis: exact there, at m³ multiplications in place of m."""

    model: FactorModel

    @cached_property
    def tensor(self) -> Array:
        """(m, m, m) B⁺_i (B_j * B_k)."""
        basis = self.model.basis
        return np.einsum("in,nj,nk->ijk", self.model.projection, basis, basis, optimize=True)

    def reflection(self, coefficients: ArrayLike) -> Array:
        """Λ (…, m, m) of a light or a surface with coefficients (…, m)."""
        return np.einsum("ijk,...k->...ij", self.tensor, np.asarray(coefficients, dtype=float))

    def product(self, first: ArrayLike, *others: ArrayLike) -> Array:
        """Coefficients (…, m) of the product of spectra, projected into the span after every factor."""
        found = np.asarray(first, dtype=float)
        for factor in others:
            found = np.einsum("...ij,...j->...i", self.reflection(factor), found)
        return found
