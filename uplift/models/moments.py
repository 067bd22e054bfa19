"""The moments model: bounded maximum-entropy spectra, stored as trigonometric moments
of the mirrored signal.

g(φ) = ½ + arctan(p₀ + 2 Σ p_l cos lφ) / π. All real p give a valid spectrum, so the fit
works on p. The moments c are linear in the spectrum, so cubes store c.
`uplift.models.duality` converts between p and c.

References
----------
Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals
for spectral rendering", ACM TOG 38(4). docs/mathematics.md, 2 to 4.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Mask
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value
from uplift.models import duality
from uplift.models.arithmetic import arctan, arctan_difference
from uplift.models.model import Model

MIN_COUNT = 3
MAX_COUNT = 17
"""Numbers of coefficients: the zeroth and 2 to 16 moments."""
MAX_SAFE_LINEAR = 30.0
"""Bound of the linear part up to which single precision keeps colours
(tests/models/test_models.py): reflectances from .01 to .99.
"""
MATCH_NODES = 1024
"""Nodes of the integrals from reflectances to moments."""

WARPS: dict[str, tuple[tuple[float, float, float], ...]] = {
    "none": (),
    "vision": ((1.0, 0.0072, 538.0),),
    "colour": ((1.0, 0.0263, 480.0), (1.066, 0.0227, 578.0)),
}
"""Terms (a, k, m) of increasing functions w(λ) = Σ a tanh(k (λ − m)); without any, w(λ)
= λ.

The density of ``vision`` is that by which hero-wavelength renderers sample,
1/cosh²(0.0072 (λ − 538)): Radziszewski, Boryczko & Alda 2009, "An improved technique
for full spectral rendering". That of ``colour`` has a peak for blue and one for green
and red, fitted to the colours of the shipped atlases at three coefficients
(docs/reproductions.md).
"""


def warped(name: str, wavelengths: Any, tanh: Callable[[Any], Any] = np.tanh) -> Any:
    """Return w(λ) of a warp at wavelengths in nm, by the hyperbolic tangent of their
    array library.
    """
    terms = WARPS[name]
    return (
        sum(a * tanh(k * (wavelengths - m)) for a, k, m in terms)
        if terms
        else wavelengths
    )


@dataclass(frozen=True)
class Moments(Model):
    """Bounded maximum-entropy spectra of given moments.

    The phase φ increases from −π at the start of a range of wavelengths to 0 at its
    end; the spectrum is constant outside.

    Parameters
    ----------
    count : int
        Number of coefficients, from 3 to 17: the zeroth moment and 2 to 16 others.
    start, end : float
        Range in nm.
    warp : {"none", "vision", "colour"}
        Increasing function applied to the wavelength before its linear map to the
        phase.

    Raises
    ------
    OptionError
        The count is out of range, or the range is empty.
    UnknownNameError
        The warp is unknown.

    References
    ----------
    Peters et al. 2019; docs/mathematics.md, 2 to 4.

    Examples
    --------
    >>> from uplift.models import evaluate
    >>> grey = Moments(9).from_storage([0.5] + 8 * [0.0])
    >>> evaluate(Moments(9), grey[None], [400, 700]).round(12).tolist()
    [[0.5, 0.5]]
    """

    count: int = 9
    start: float = 380.0
    end: float = 780.0
    warp: str = "none"
    name = "moments"

    @classmethod
    def from_parameters(cls, **parameters: Any) -> "Moments":
        return cls(parameters["count"], **parameters["phase"])

    def __post_init__(self) -> None:
        if self.warp not in WARPS:
            raise unknown_name(str(self.warp), WARPS, "warp")
        if not 0 < self.start < self.end < np.inf:
            raise OptionError(
                f"a phase needs 0 < start < end < inf, got start {self.start} and end "
                f"{self.end}"
            )
        if not MIN_COUNT <= self.count <= MAX_COUNT:
            raise OptionError(
                f"coefficients of the moments model must be in [{MIN_COUNT}, "
                f"{MAX_COUNT}], "
                f"got {format_value(self.count)}",
                hint="the count includes the zeroth moment",
            )

    def phase(self, wavelengths: ArrayLike) -> Array:
        """Map wavelengths to phases.

        Parameters
        ----------
        wavelengths : array_like, shape (N,)
            Wavelengths in nm; those outside the range take the phase of its nearer end.

        Returns
        -------
        ndarray, shape (N,)
            φ in [−π, 0].
        """
        # φ = π (w(λ) − w(λ₀)) / (w(λ₁) − w(λ₀)) − π
        low, high = warped(self.warp, np.array([self.start, self.end]))
        inside = np.clip(np.asarray(wavelengths, dtype=float), self.start, self.end)
        return np.asarray(
            np.pi * (warped(self.warp, inside) - low) / (high - low) - np.pi
        )

    def basis(self, wavelengths: ArrayLike) -> Array:
        # B p = p₀ + 2 Σ p_l cos lφ
        return duality.cosine_basis(self.phase(wavelengths), self.count)

    def to_reflectance(self, x: Any) -> Any:
        # S(x) = ½ + arctan(x) / π: Peters et al. 2019
        return 0.5 + arctan(x) / np.pi

    def derivative(self, x: Any) -> Any:
        # S′(x) = 1 / (π (1 + x²))
        return 1 / (np.pi * (1 + x * x))

    def from_reflectance(self, reflectance: Any) -> Any:
        return reflectance.__array_namespace__().tan(np.pi * (reflectance - 0.5))

    def reflectance_change(self, x: Array, change: Array) -> Array:
        return arctan_difference(x, change) / np.pi

    def constant(self) -> Array:
        return np.eye(self.count)[0]

    def metric_diagonal(self) -> Array:
        # A unit of p_j adds 1 to the squared value and j² to the squared derivative
        # over φ.
        return 1 + np.arange(self.count, dtype=float) ** 2

    def to_storage(self, multipliers: ArrayLike) -> Array:
        rows = np.asarray(multipliers, dtype=float)
        return duality.moments_from_multipliers(
            rows.reshape(-1, rows.shape[-1])
        ).reshape(rows.shape)

    def from_storage(self, coefficients: ArrayLike) -> Array:
        rows = np.asarray(coefficients, dtype=float)
        return np.asarray(
            duality.multipliers_from_moments(rows.reshape(-1, rows.shape[-1]))
        ).reshape(rows.shape)

    def try_from_storage(self, coefficients: Array) -> tuple[Array, Mask]:
        return duality.try_multipliers(coefficients)

    def is_float32_safe(self, multipliers: Array) -> Mask:
        # The linear part is at most |p₀| + 2 Σ |p_l|.
        largest = np.abs(multipliers[:, 0]) + 2 * np.abs(multipliers[:, 1:]).sum(axis=1)
        return largest <= MAX_SAFE_LINEAR

    def describe(self) -> dict[str, Any]:
        phase = {"start": self.start, "end": self.end, "warp": self.warp}
        return {"name": self.name, "count": self.count, "phase": phase}


def moment_matrix(model: Moments, wavelengths: Array) -> Array:
    """Weights (N, C) that turn reflectances (n, N), linear between the wavelengths,
    into moments.
    """
    phase = -np.pi * (np.arange(MATCH_NODES) + 0.5) / MATCH_NODES
    at = np.interp(phase, model.phase(wavelengths), np.arange(len(wavelengths)))
    samples = np.stack(
        [
            np.interp(at, np.arange(len(wavelengths)), row)
            for row in np.eye(len(wavelengths))
        ]
    )
    # c_j = (1/π) ∫ g(φ) cos jφ dφ by midpoints
    weights = duality.cosine_basis(phase, model.count) / MATCH_NODES
    weights[:, 1:] /= 2
    return samples @ weights
