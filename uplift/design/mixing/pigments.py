"""What paints are made of: absorption K and scattering S, measured, or supposed from one reflectance.

Mixtures have the means of both (D. R. Duncan 1940, Proc. Phys. Soc. 52; 10.7). From reflectances on two grounds
both follow. From that of hiding paint, R, follows K/S alone (10.6, where the thesis prints 1 − R² for (1 − R)²),
and S has to be supposed: S = R^p. With p = 0 it is the same everywhere, the single-constant theory, in which a
trace of a dark paint rules every mixture. Paints that have been measured scatter less where they are dark: the
larger p, up to some 0.8, the nearer their mixtures come, but the sooner blue and yellow give grey. The default, p =
½, is a compromise; docs/mixing.md measures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing.validation import length, shares, summed

GRADING = 0.5
"""p of S = R^p."""
DARKEST = 1e-4
"""Least reflectance that K and S are told from; K has no limit below."""
SLACK = 1e-3
"""By how much measurements on two grounds may contradict one another, as rounding does."""
OPAQUE = 1e-3
"""Least transmittance from which K and S can be told apart."""


@dataclass(frozen=True, eq=False)
class Pigment:
    """``absorption`` K and ``scattering`` S (…, N), per unit thickness, not negative."""

    absorption: Array
    scattering: Array

    def mixed(self, parts: ArrayLike) -> Pigment:
        """The mixture (…, N) of ``parts`` (…, n) of pigments (…, n, N) (10.7). Raises `OptionError`."""
        weights = shares(parts)
        return Pigment(summed(self.absorption, weights), summed(self.scattering, weights))


def absorption_over_scattering(reflectance: ArrayLike) -> Array:
    """K/S (…) of hiding paint of reflectance (…) in (0, 1] (10.6, turned round)."""
    R = np.asarray(reflectance, dtype=float)
    return (1 - R) ** 2 / (2 * R)


def of_hiding(reflectance: ArrayLike, grading: float = GRADING) -> Pigment:
    """K and S = R^``grading`` of hiding paint of reflectance R (…, N) in [0, 1], or `DARKEST` if that is more."""
    R = np.clip(np.asarray(reflectance, dtype=float), DARKEST, 1)
    S = R ** length(grading, "grading")
    return Pigment(S * absorption_over_scattering(R), S)


def on_two_grounds(
    first: ArrayLike,
    second: ArrayLike,
    grounds: tuple[ArrayLike, ArrayLike] = (0.0, 1.0),
    thickness: float = 1.0,
) -> Pigment:
    """K and S of paint ``thickness`` thick, from reflectances (…, N) on two ``grounds``, by default black and white.

    On a ground g the paint has R = R₀ + T² g / (1 − R₀ g), linear in R₀ and T² − R₀² once multiplied out. Of R₀ and
    T, with the absorptance A = 1 − R₀ − T: cosh γX = 1 + A (A + 2R₀) / 2T, SX = γX R₀ / (T sinh γX) and KX = γX A
    (1 − R₀ + T) / (2T sinh γX), which have no differences of like numbers for S → 0 or K → 0.

    Raises `ColourError` where no paint has these reflectances, or it hides the ground; `OptionError` for equal
    grounds.
    """
    g1, g2 = (np.asarray(ground, dtype=float) for ground in grounds)
    R1, R2 = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    determinant = g2 - g1 + g1 * g2 * (R1 - R2)
    if not (np.abs(g2 - g1) > SLACK).all() or not length(thickness):
        raise OptionError("K and S need two grounds, and some paint", hint="measure on black and on white")
    R0 = (R1 * g2 - R2 * g1) / determinant
    through = ((1 + R1 * g1) * R2 - (1 + R2 * g2) * R1) / determinant + R0**2
    T = np.sqrt(np.maximum(through, 0))
    if not (T > OPAQUE).all():
        raise ColourError("hides the ground, or is lighter on the darker", hint="measure a thinner layer")
    if not ((R0 >= -SLACK) & (R0 + T <= 1 + SLACK)).all():
        raise ColourError("no paint has these reflectances on these grounds", hint="check which is on which")
    return _of_layer(np.maximum(R0, 0), T, thickness)


def _of_layer(R0: Array, T: Array, thickness: float) -> Pigment:
    A = np.maximum(1 - R0 - T, 0)
    more = A * (A + 2 * R0) / (2 * T)  # cosh γX − 1
    sinh = np.sqrt(more * (more + 2))
    ratio = np.where(sinh > 0, np.log1p(more + sinh) / np.where(sinh > 0, sinh, 1), 1) / (T * thickness)
    return Pigment(ratio * A * (1 - R0 + T) / 2, ratio * R0)
