"""Interface of spectrum models: a sigmoid of a linear function of the multipliers (docs/mathematics.md, 2)."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Mask
from uplift.models.arithmetic import matmul_rows
from uplift.models.duality import PRECISE, Quadrature


class Model(Protocol):
    """A family of reflectance spectra g(λ) = squash(basis(λ) · p), where all real p give values in (0, 1).

    The fit works on the multipliers p; a cube stores the coefficients c. ``squash`` and ``slope`` use the array API,
    so that numpy and JAX run the same code.
    """

    @property
    def name(self) -> str:
        """Name of the family in cube files.

        Returns
        -------
        str
        """
        ...

    @property
    def count(self) -> int:
        """Number of coefficients per spectrum, C.

        Returns
        -------
        int
        """
        ...

    def basis(self, wavelengths: ArrayLike) -> Array:
        """Evaluate the basis of the linear part.

        Parameters
        ----------
        wavelengths : array_like, shape (N,)
            Wavelengths in nm.

        Returns
        -------
        ndarray, shape (N, C)
        """
        ...

    def squash(self, x: Any) -> Any:
        """Map the linear part to reflectance: increasing, ½ at 0.

        Parameters
        ----------
        x : array
            Linear part, of numpy or JAX.

        Returns
        -------
        array
            Reflectance in (0, 1).
        """
        ...

    def slope(self, x: Any) -> Any:
        """Evaluate the derivative of `squash`.

        Parameters
        ----------
        x : array
            Linear part, of numpy or JAX.

        Returns
        -------
        array
        """
        ...

    def squash_difference(self, x: Array, change: Array) -> Array:
        """Evaluate squash(x + change) − squash(x), faster than two calls of `squash` if changes are small.

        Parameters
        ----------
        x, change : ndarray, shape (N, n)
            Linear part and its change, a column per spectrum.

        Returns
        -------
        ndarray, shape (N, n)
        """
        ...

    def unsquash(self, reflectance: Array) -> Array:
        """Evaluate the inverse of `squash`.

        Parameters
        ----------
        reflectance : ndarray
            Reflectance in (0, 1).

        Returns
        -------
        ndarray
            Linear part.
        """
        ...

    def constant(self) -> Array:
        """Return the multipliers whose linear part is 1 at all wavelengths.

        Returns
        -------
        ndarray, shape (C,)
        """
        ...

    def roughness(self) -> Array:
        """Return the diagonal of the smoothness metric M (docs/mathematics.md, 5).

        Returns
        -------
        ndarray, shape (C,)
        """
        ...

    def to_storage(self, multipliers: ArrayLike, quadrature: Quadrature = PRECISE) -> Array:
        """Convert multipliers to the coefficients that cubes store.

        Parameters
        ----------
        multipliers : array_like, shape (..., C)
            Multipliers.
        quadrature : Quadrature
            How spectra are integrated, if the coefficients are integrals.

        Returns
        -------
        ndarray, shape (..., C)
        """
        ...

    def from_storage(self, coefficients: ArrayLike) -> Array:
        """Convert stored coefficients to multipliers.

        Parameters
        ----------
        coefficients : array_like, shape (..., C)
            Coefficients.

        Returns
        -------
        ndarray, shape (..., C)
        """
        ...

    def rounds_safely(self, multipliers: Array) -> Mask:
        """Return which spectra keep their colour when their coefficients are rounded to single precision.

        Parameters
        ----------
        multipliers : ndarray, shape (n, C)
            Multipliers.

        Returns
        -------
        ndarray of bool, shape (n,)
            True if linear RGB changes by at most 2e-7, about the rounding of RGB itself. False decides nothing.
        """
        ...

    def try_from_storage(self, coefficients: Array) -> tuple[Array, Mask]:
        """Convert coefficients that may belong to no reflectance.

        Parameters
        ----------
        coefficients : ndarray, shape (n, C)
            Coefficients.

        Returns
        -------
        multipliers : ndarray, shape (n, C)
            Multipliers; arbitrary where invalid.
        valid : ndarray of bool, shape (n,)
            Whether the coefficients belong to a reflectance.
        """
        ...

    def describe(self) -> dict[str, Any]:
        """Describe the model for `uplift.models.from_description`.

        Returns
        -------
        dict
            JSON values.
        """
        ...


def reflectance(model: Model, coefficients: ArrayLike, wavelengths: ArrayLike) -> Array:
    """Evaluate the spectra of stored coefficients.

    Parameters
    ----------
    model : Model
        The spectrum model.
    coefficients : array_like, shape (n, C)
        Stored coefficients.
    wavelengths : array_like, shape (N,)
        Wavelengths in nm.

    Returns
    -------
    ndarray, shape (n, N)
        Reflectance in [0, 1].
    """
    return evaluate(model, model.from_storage(coefficients), wavelengths)


def evaluate(model: Model, multipliers: Array, wavelengths: ArrayLike) -> Array:
    """Evaluate the spectra of multipliers.

    Parameters
    ----------
    model : Model
        The spectrum model.
    multipliers : ndarray, shape (n, C)
        Multipliers.
    wavelengths : array_like, shape (N,)
        Wavelengths in nm.

    Returns
    -------
    ndarray, shape (n, N)
        Reflectance in [0, 1].
    """
    return np.asarray(model.squash(matmul_rows(multipliers, model.basis(wavelengths).T)))
