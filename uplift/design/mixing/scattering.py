"""Assumed scattering S of opaque paints, whose reflectance R determines K/S only.

`PowerOfReflectance`, S = R^p
    p = 0, equal scattering, is the single-constant theory. p = ½ lets dark paints scatter less.
`Dispersive`, S = Y^¾ exp(h / 4)
    Y is the luminance factor of the paint. h(λ) is the mean of √(K/S) at wavelengths below λ, less the mean above it,
    both with weights exp(−\\|λ − λ'\\| / 40 nm). The refractive index of a pigment rises on the long-wave side of an
    absorption band and falls on its short-wave side (anomalous dispersion), and scattering grows with the difference
    from the index of the binder. A yellow pigment therefore scatters most in the green, where its absorption ends; a
    blue one scatters little there. That is why both together are green.

docs/mixing.md compares both with measured paints.

References
----------
C. F. Bohren & D. R. Huffman, *Absorption and Scattering of Light by Small Particles*, Wiley 1983, chapter 9
(anomalous dispersion).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.mixing.validation import as_length

LUMINANCE_EXPONENT = 0.75
DISPERSION = 0.25
"""Weight of h in the logarithm of S."""
REACH = 40.0
"""Distance in nm at which the weight of absorption in h falls to 1/e."""
DARKEST_DISPERSED = 0.01
"""Smallest reflectance that h is computed from; √(K/S) diverges at 0, where the colour no longer determines it."""

Scattering = Callable[[Array], Array]
"""From reflectances (..., N) in (0, 1] to S (..., N), greater than 0, of which white has 1."""


@dataclass(frozen=True)
class PowerOfReflectance:
    """S = R^p.

    Parameters
    ----------
    exponent : float
        p, at least 0.

    Raises
    ------
    OptionError
        The exponent is negative or not finite (code ``invalid-grading``).
    """

    exponent: float

    def __post_init__(self) -> None:
        as_length(self.exponent, "exponent of the scattering", code="invalid-grading")

    def __call__(self, reflectance: Array) -> Array:
        return np.asarray(reflectance**self.exponent)


@dataclass(frozen=True, eq=False)
class Dispersive:
    """S = Y^¾ exp(h / 4), made by `dispersive`.

    Parameters
    ----------
    luminance : ndarray of shape (N,)
        Weights of Y, of sum 1.
    imbalance : ndarray of shape (N, N)
        Matrix from √(K/S) to h. Each row sums to 0: a grey paint has h = 0.
    exponent, weight : float
        Exponent of Y and factor of h.
    """

    luminance: Array
    imbalance: Array
    exponent: float = LUMINANCE_EXPONENT
    weight: float = DISPERSION

    def __call__(self, reflectance: Array) -> Array:
        R = np.maximum(reflectance, DARKEST_DISPERSED)
        h = ((1 - R) / np.sqrt(2 * R)) @ self.imbalance.T
        Y = (reflectance @ self.luminance)[..., None]
        return np.asarray(Y**self.exponent * np.exp(self.weight * h))


def dispersive(sensor: Sensor, further: ArrayLike = ()) -> Dispersive:
    """Make the dispersive scattering of spectra at the wavelengths of a sensor.

    Parameters
    ----------
    sensor : Sensor
        Y and h are sums over its wavelengths. Y is for light of equal energy, as it belongs to the paint.
    further : array_like of shape (n,), optional
        Wavelengths in nm of samples that follow those of the sensor. They enter no sum. Beyond the range of the sensor,
        h is that of its end.

    Returns
    -------
    Dispersive
        The scattering of spectra (..., N + n).
    """
    inner = sensor.wavelengths
    outer = np.concatenate([inner, np.clip(np.asarray(further, dtype=float), inner[0], inner[-1])])
    distance = outer[:, None] - inner
    weights = np.exp(-np.abs(distance) / REACH)
    below, above = weights * (distance >= 0), weights * (distance <= 0)
    imbalance = np.zeros((len(outer), len(outer)))
    imbalance[:, : len(inner)] = below / below.sum(axis=1)[:, None] - above / above.sum(axis=1)[:, None]
    luminance = np.zeros(len(outer))
    luminance[: len(inner)] = sensor.cmfs[:, 1] / sensor.cmfs[:, 1].sum()
    return Dispersive(luminance, imbalance)


SQUARE_ROOT, CONSTANT = PowerOfReflectance(0.5), PowerOfReflectance(0.0)
