"""Absorption K and scattering S of paints, from measured reflectances.

Mixtures average both (eq. 10.7). Reflectances on two grounds determine both. The reflectance R of opaque paint
determines K/S only (eq. 10.6, where Fishkin 1983 prints 1 − R² for (1 − R)²), so S must be assumed; see
`uplift.design.mixing.scattering`.

References
----------
D. R. Duncan, Proc. Phys. Soc. 52, 1940; Fishkin 1983, eq. 10.6, 10.7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing.scattering import Scattering
from uplift.design.mixing.validation import as_length, as_shares, weighted_sum

DARKEST = 1e-4
"""Smallest reflectance that K and S are derived from; K diverges at 0."""
SLACK = 1e-3
"""Contradiction between measurements on two grounds that is accepted as rounding."""
MIN_TRANSMITTANCE = 1e-3
"""Smallest transmittance at which K and S can be separated."""


@dataclass(frozen=True, eq=False)
class Pigment:
    """Absorption and scattering of paint.

    Parameters
    ----------
    absorption, scattering : ndarray of shape (..., N)
        K and S per unit thickness, at least 0.
    """

    absorption: Array
    scattering: Array

    def mix(self, parts: ArrayLike) -> Pigment:
        """Mix the pigments along the last axis but one (eq. 10.7).

        Parameters
        ----------
        parts : array_like of shape (..., n)
            Amounts of the pigments (..., n, N).

        Returns
        -------
        Pigment
            The mixture (..., N).

        Raises
        ------
        OptionError
            A part is negative or not finite, or all are 0 (code ``invalid-parts``).
        """
        weights = as_shares(parts)
        return Pigment(weighted_sum(self.absorption, weights), weighted_sum(self.scattering, weights))


def absorption_over_scattering(reflectance: ArrayLike) -> Array:
    """Return K/S of opaque paint (eq. 10.6).

    Parameters
    ----------
    reflectance : array_like of shape (...)
        Reflectance in (0, 1].

    Returns
    -------
    ndarray of shape (...)
        K/S.
    """
    R = np.asarray(reflectance, dtype=float)
    return (1 - R) ** 2 / (2 * R)


def from_opaque(reflectance: ArrayLike, scattering: Scattering) -> Pigment:
    """Derive K and S from the reflectance of opaque paint.

    Parameters
    ----------
    reflectance : array_like of shape (..., N)
        Reflectance in [0, 1]; values below `DARKEST` are raised to it.
    scattering : Scattering
        S that is assumed for a reflectance.

    Returns
    -------
    Pigment
        Absorption and scattering (..., N).
    """
    R = np.clip(np.asarray(reflectance, dtype=float), DARKEST, 1)
    S = scattering(R)
    return Pigment(S * absorption_over_scattering(R), S)


def from_black_and_white(
    on_black: ArrayLike,
    on_white: ArrayLike,
    grounds: tuple[ArrayLike, ArrayLike] = (0.0, 1.0),
    thickness: float = 1.0,
) -> Pigment:
    """Derive K and S from reflectances on two grounds.

    Paint on a ground g has R = R₀ + T² g / (1 − R₀ g), which is linear in R₀ and T² − R₀² once multiplied out. With
    the absorptance A = 1 − R₀ − T: cosh γX = 1 + A (A + 2R₀) / 2T, SX = γX R₀ / (T sinh γX) and
    KX = γX A (1 − R₀ + T) / (2T sinh γX). These forms do not cancel for S → 0 or K → 0.

    Parameters
    ----------
    on_black, on_white : array_like of shape (..., N)
        Reflectances on the first and the second ground.
    grounds : pair of array_like of shape (..., N)
        Reflectances of the grounds, by default perfect black and perfect white.
    thickness : float
        Thickness X, greater than 0.

    Returns
    -------
    Pigment
        Absorption and scattering (..., N).

    Raises
    ------
    ColourError
        The layer is too opaque, or lighter on the darker ground (code ``layer-too-opaque``), or no paint has these
        reflectances (``impossible-paint``).
    OptionError
        The grounds are equal or the thickness is 0 (code ``equal-grounds``, ``invalid-thickness``).
    """
    g1, g2 = (np.asarray(ground, dtype=float) for ground in grounds)
    R1, R2 = np.asarray(on_black, dtype=float), np.asarray(on_white, dtype=float)
    if not (np.abs(g2 - g1) > SLACK).all():
        raise OptionError(
            "K and S need two different grounds", code="equal-grounds", hint="measure on black and on white"
        )
    if not as_length(thickness):
        raise OptionError("thickness must be greater than 0, got 0", code="invalid-thickness", hint="1 is the unit")
    determinant = g2 - g1 + g1 * g2 * (R1 - R2)
    R0 = (R1 * g2 - R2 * g1) / determinant
    squared = ((1 + R1 * g1) * R2 - (1 + R2 * g2) * R1) / determinant + R0**2
    T = np.sqrt(np.maximum(squared, 0))
    if not (T > MIN_TRANSMITTANCE).all():
        raise ColourError(
            "the layer hides the ground, or is lighter on the darker ground",
            code="layer-too-opaque",
            hint="measure a thinner layer",
        )
    if not ((R0 >= -SLACK) & (R0 + T <= 1 + SLACK)).all():
        raise ColourError(
            "no paint has these reflectances on these grounds",
            code="impossible-paint",
            hint="check the order of the grounds",
        )
    return _from_layer(np.maximum(R0, 0), T, thickness)


def _from_layer(R0: Array, T: Array, thickness: float) -> Pigment:
    A = np.maximum(1 - R0 - T, 0)
    cosh_minus_1 = A * (A + 2 * R0) / (2 * T)
    sinh = np.sqrt(cosh_minus_1 * (cosh_minus_1 + 2))
    safe = np.where(sinh > 0, sinh, 1)
    ratio = np.where(sinh > 0, np.log1p(cosh_minus_1 + sinh) / safe, 1) / (T * thickness)
    return Pigment(ratio * A * (1 - R0 + T) / 2, ratio * R0)
