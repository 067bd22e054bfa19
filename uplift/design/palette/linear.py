"""Linear model of reflection without the sharpening assumption: an m × m matrix per reflection.

References
----------
S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, eq. 5–7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.palette.factor import FactorModel


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Products of spectra in the span of a basis. They are exact there, at m³ multiplications in place of m.

    Parameters
    ----------
    model : FactorModel
        The model that has the basis.
    """

    model: FactorModel

    @cached_property
    def tensor(self) -> Array:
        """Products of basis functions, B⁺_i (B_j * B_k), shape (m, m, m)."""
        basis = self.model.basis
        return np.einsum("in,nj,nk->ijk", self.model.projection, basis, basis, optimize=True)

    def reflection(self, coefficients: ArrayLike) -> Array:
        """Compute the matrix Λ of a light or a surface.

        Parameters
        ----------
        coefficients : array_like, shape (..., m)
            Coefficients of the light or the surface.

        Returns
        -------
        ndarray, shape (..., m, m)
            The matrix.
        """
        return np.einsum("ijk,...k->...ij", self.tensor, np.asarray(coefficients, dtype=float))

    def product(self, first: ArrayLike, *others: ArrayLike) -> Array:
        """Multiply spectra, projecting into the span after every factor.

        Parameters
        ----------
        first : array_like, shape (..., m)
            Coefficients of the first factor.
        *others : array_like, shape (..., m)
            Coefficients of the other factors.

        Returns
        -------
        ndarray, shape (..., m)
            Coefficients of the product.
        """
        product = np.asarray(first, dtype=float)
        for factor in others:
            product = np.einsum("...ij,...j->...i", self.reflection(factor), product)
        return product
