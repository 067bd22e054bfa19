"""Interface of spectrum models: g = S(B p), a sigmoid S of a linear function of the
multipliers p.

docs/mathematics.md, 2. The fit works on the multipliers; a cube stores coefficients c.
"""

from abc import ABC, abstractmethod
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Mask
from uplift.models.arithmetic import blocked_matmul

COMPONENTS = 3
"""Components of a colour."""


@dataclass(frozen=True)
class Model(ABC):
    """A family of reflectance spectra: all real multipliers p give values in (0, 1).

    `to_reflectance`, its inverse and `derivative` use the array API, so that numpy and
    JAX run the same code. The multipliers are stored unless a model has better
    coefficients.
    """

    name: ClassVar[str]

    @classmethod
    def from_parameters(cls, **parameters: Any) -> "Model":
        """Create the model from what `describe` has next to its name.

        Parameters
        ----------
        **parameters
            JSON values.

        Returns
        -------
        Model
        """
        return cls(**parameters)

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of coefficients per spectrum, C."""

    @property
    def is_determined(self) -> bool:
        """Whether the colour alone determines the spectrum."""
        return self.count == COMPONENTS

    @abstractmethod
    def basis(self, wavelengths: ArrayLike) -> Array:
        """Evaluate the basis B (N, C) of the linear part at wavelengths (N,) in nm."""

    @abstractmethod
    def to_reflectance(self, x: Any) -> Any:
        """Map the linear part, an array of numpy or JAX, to reflectance S(x):
        increasing, ½ at 0.
        """

    @abstractmethod
    def derivative(self, x: Any) -> Any:
        """Evaluate S′(x)."""

    @abstractmethod
    def from_reflectance(self, reflectance: Any) -> Any:
        """Return the linear part of reflectances in (0, 1): the inverse of
        `to_reflectance`.
        """

    def reflectance_change(self, x: Array, change: Array) -> Array:
        """Evaluate S(x + change) − S(x), for columns (N, n) of linear parts and their
        changes.
        """
        return self.to_reflectance(x + change) - self.to_reflectance(x)

    @abstractmethod
    def constant(self) -> Array:
        """Return the multipliers (C,) whose linear part is 1 at all wavelengths."""

    @abstractmethod
    def metric_diagonal(self) -> Array:
        """Return the diagonal (C,) of the smoothness metric M
        (docs/mathematics.md, 5).
        """

    def to_storage(self, multipliers: ArrayLike) -> Array:
        """Convert multipliers (..., C) to the coefficients (..., C) that
        cubes store.
        """
        return np.array(multipliers, dtype=float)

    def from_storage(self, coefficients: ArrayLike) -> Array:
        """Convert coefficients (..., C) to multipliers (..., C); those of no
        reflectance raise `UpliftError`.
        """
        return np.array(coefficients, dtype=float)

    def try_from_storage(self, coefficients: Array) -> tuple[Array, Mask]:
        """Convert coefficients (n, C) to multipliers (n, C), arbitrary where not valid
        (n,): of no reflectance.
        """
        return np.array(coefficients, dtype=float), np.ones(
            len(coefficients), dtype=bool
        )

    def is_float32_safe(self, multipliers: Array) -> Mask:
        """Return which spectra (n,) keep linear RGB to 2e-7 if their coefficients are
        rounded to single precision.

        False decides nothing.
        """
        return np.zeros(len(multipliers), dtype=bool)

    def describe(self) -> dict[str, Any]:
        """Describe the model in JSON values, for `uplift.models.from_description`."""
        return {"name": self.name, **asdict(self)}


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
    return np.asarray(
        model.to_reflectance(blocked_matmul(multipliers, model.basis(wavelengths).T))
    )
