"""What a spectrum model is: a sigmoid of a linear function of its multipliers (docs/mathematics.md, 2)."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models.duality import Quadrature, quadrature
from uplift.models.matmul import matmul_rows


class Model(Protocol):
    """A family of reflectance spectra g(λ) = squash(basis(λ) · p), every p a valid spectrum in (0, 1).

    The fit works on the multipliers p; a cube stores the coefficients c. ``squash`` and ``slope`` are
    written to the array API, so that numpy and JAX run the same lines.
    """

    @property
    def name(self) -> str: ...

    @property
    def count(self) -> int:
        """Numbers per spectrum, C."""
        ...

    def basis(self, wavelengths: ArrayLike) -> Array:
        """(N, C) values of the linear part at ``wavelengths`` (nm)."""
        ...

    def squash(self, x: Any) -> Any:
        """Reflectance in (0, 1) of the linear part; monotone, ½ at 0."""
        ...

    def slope(self, x: Any) -> Any:
        """Derivative of ``squash``."""
        ...

    def squash_difference(self, x: Array, change: Array) -> Array:
        """squash(x + change) − squash(x) of (N, n), quicker where little changes. numpy alone."""
        ...

    def unsquash(self, reflectance: Array) -> Array:
        """The linear part that ``squash`` takes to a reflectance in (0, 1). numpy alone."""
        ...

    def constant(self) -> Array:
        """(C,) multipliers whose linear part is 1 everywhere."""
        ...

    def roughness(self) -> Array:
        """(C,) diagonal of the smoothness metric M (docs/mathematics.md, 5)."""
        ...

    def to_storage(self, multipliers: ArrayLike, quadrature: Quadrature = quadrature) -> Array:
        """Coefficients (…, C) of multipliers (…, C); where they are integrals, by ``quadrature``."""
        ...

    def from_storage(self, coefficients: ArrayLike) -> Array:
        """Multipliers (…, C) of coefficients (…, C)."""
        ...

    def describe(self) -> dict[str, Any]:
        """What `uplift.models.from_description` needs to make this model again."""
        ...


def reflectance(model: Model, coefficients: ArrayLike, wavelengths: ArrayLike) -> Array:
    """Reflectance (n, N) at wavelengths (N,) nm of stored coefficients (n, C), as any reader will see it."""
    return evaluate(model, model.from_storage(coefficients), wavelengths)


def evaluate(model: Model, multipliers: Array, wavelengths: ArrayLike) -> Array:
    """Reflectance (n, N) at wavelengths (N,) nm of multipliers (n, C)."""
    return np.asarray(model.squash(matmul_rows(multipliers, model.basis(wavelengths).T)))
