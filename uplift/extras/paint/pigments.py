"""Paints that absorb (K) and scatter (S) light, per unit thickness, by the theory of
Kubelka and Munk.

With γ = √(K (K + 2S)) a layer of thickness X has (Fishkin 1983, eq. 10.2)

    T = γ / Δ,    R = S sinh γX / Δ,    Δ = (K + S) sinh γX + γ cosh γX.

Mixtures average K and S (Duncan, eq. 10.7). Reflectances on two grounds determine both.
The reflectance R of opaque paint determines K/S only (eq. 10.6, where Fishkin 1983
prints 1 − R² for (1 − R)²), so S must be assumed: as R^p, where p = 0 is the
single-constant theory, or as Y^¾ exp(h / 4), where Y is the luminance factor and h(λ)
the mean of √(K/S) below λ less that above it, weighted by exp(−abs(λ − λ') / 40 nm).
The refractive index of a pigment rises on the long-wave side of an absorption band
(anomalous dispersion), and scattering grows with its difference from the binder's:
yellow pigments scatter most in the green, blue ones little, and both together are
green. docs/mixing.md compares them.

P. Kubelka and F. Munk 1931; P. Kubelka, J. Opt. Soc. Am. 38, 1948; D. R. Duncan, Proc.
Phys. Soc. 52, 1940; C. F. Bohren & D. R. Huffman,
*Absorption and Scattering of Light by Small Particles*, 1983, chapter 9.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.extras.paint.optics import (
    NO_SURFACE,
    TINY,
    Coat,
    Layer,
    Surface,
    as_shares,
    check_thickness,
    weighted_sum,
)

DARKEST = 1e-4  # smallest reflectance that K and S are derived from; K diverges at 0
# contradiction between measurements on two grounds that is accepted as rounding
SLACK = 1e-3
MIN_TRANSMITTANCE = 1e-3  # smallest transmittance at which K and S can be separated
REACH = 40.0  # distance in nm at which the weight of absorption in h falls to 1/e
# Smallest reflectance that h is computed from; √(K/S) diverges at 0, where the colour
# no longer determines it.
DARKEST_DISPERSED = 0.01

# From reflectances (..., N) in (0, 1] to S (..., N), greater than 0, of which white has
# 1.
Scattering = Callable[[Array], Array]

SQUARE_ROOT: Scattering = np.sqrt
CONSTANT: Scattering = np.ones_like


@dataclass(frozen=True, eq=False)
class Dispersive:
    """S = Y^exponent exp(weight · h), made by `dispersive`."""

    luminance: Array  # (N,) weights of Y, of sum 1
    # (N, N) from √(K/S) to h; rows sum to 0, so that a grey paint has h = 0
    imbalance: Array
    exponent: float = 0.75
    weight: float = 0.25

    def __call__(self, reflectance: Array) -> Array:
        R = np.maximum(reflectance, DARKEST_DISPERSED)
        h = ((1 - R) / np.sqrt(2 * R)) @ self.imbalance.T
        Y = (reflectance @ self.luminance)[..., None]
        return Y**self.exponent * np.exp(self.weight * h)


def dispersive(sensor: Sensor, further: ArrayLike = ()) -> Dispersive:
    """Make the dispersive scattering of spectra at the wavelengths of a sensor.

    Parameters
    ----------
    sensor : Sensor
        Y, for light of equal energy, and h are sums over its wavelengths.
    further : array_like of shape (n,), optional
        Wavelengths in nm of samples that follow those of the sensor and enter no sum;
        beyond its range h is constant.

    Returns
    -------
    Dispersive
        The scattering of spectra (..., N + n).
    """
    inner = sensor.wavelengths
    outer = np.concatenate(
        [inner, np.clip(np.asarray(further, dtype=float), inner[0], inner[-1])]
    )
    distance = outer[:, None] - inner
    weights = np.exp(-np.abs(distance) / REACH)
    below = weights * (distance >= 0)
    above = weights * (distance <= 0)
    imbalance = np.zeros((len(outer), len(outer)))
    imbalance[:, : len(inner)] = (
        below / below.sum(axis=1)[:, None] - above / above.sum(axis=1)[:, None]
    )
    luminance = np.zeros(len(outer))
    luminance[: len(inner)] = sensor.cmfs[:, 1] / sensor.cmfs[:, 1].sum()
    return Dispersive(luminance, imbalance)


@dataclass(frozen=True, eq=False)
class Pigment:
    """Absorption and scattering of paint, in Kubelka and Munk's theory.

    Arrays of JAX are accepted as well, so that a fit can differentiate.
    """

    absorption: Array  # (..., N) K per unit thickness, at least 0
    scattering: Array  # (..., N) S per unit thickness, at least 0

    @property
    def gamma(self) -> Array:
        """γ = √(K (K + 2S)), shape (..., N)."""
        xp = self.absorption.__array_namespace__()
        return xp.sqrt(self.absorption * (self.absorption + 2 * self.scattering))

    def select(self, rows: Sequence[int]) -> "Pigment":
        """Return some of the pigments of the first axis."""
        return Pigment(self.absorption[rows], self.scattering[rows])

    def mix(self, parts: ArrayLike) -> "Pigment":
        """Mix the pigments along the last axis but one by parts (..., n) (eq. 10.7)."""
        weights = as_shares(parts)
        return Pigment(
            weighted_sum(self.absorption, weights),
            weighted_sum(self.scattering, weights),
        )

    def opaque_reflectance(self) -> Array:
        """Return the reflectance (..., N) of opaque paint, the limit X → ∞
        (eq. 10.5).
        """
        K = self.absorption
        S = self.scattering
        xp = K.__array_namespace__()
        return S / xp.maximum(K + S + self.gamma, TINY)

    def layer(self, thickness: ArrayLike) -> Layer:
        """Return the optical properties of a layer of a thickness X (...) in units of
        1/K and 1/S (eq. 10.2).

        Numerators and denominators are divided by γ e^γX, which prevents overflow and
        covers K → 0 and S → 0.
        """
        xp = self.absorption.__array_namespace__()
        X = np.asarray(thickness, dtype=float)[..., None]
        gamma = self.gamma
        path = 2 * gamma * X
        sinh = xp.where(path > 0, -xp.expm1(-path) / xp.maximum(2 * gamma, TINY), X)
        cosh = (1 + xp.exp(-path)) / 2
        delta = (self.absorption + self.scattering) * sinh + cosh
        return Layer(self.scattering * sinh / delta, xp.exp(-path / 2) / delta)

    def coat(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        surface: Surface = NO_SURFACE,
    ) -> Coat:
        """Make a coat of the pigments (n, N), mixed by parts (..., n).

        Parameters
        ----------
        parts : array_like of shape (..., n)
            Amounts of the pigments.
        thickness : float, optional
            Thickness in units of 1/K and 1/S, by default opaque.
        surface : Surface
            Surface of the vehicle.

        Returns
        -------
        Coat
            The coat; ``coat.over(ground)`` is its reflectance on a ground.

        Raises
        ------
        OptionError
            Parts or thickness are invalid.
        """
        check_thickness(thickness)
        mixture = self.mix(parts)
        if thickness is not None:
            return Coat(mixture.layer(thickness), surface)
        reflectance = mixture.opaque_reflectance()
        return Coat(Layer(reflectance, np.zeros_like(reflectance)), surface)

    def amy_opaque_reflectance(self) -> Array:
        """Return the reflectance (..., N) of opaque paint in Amy's approximation for
        strong absorption (eq. 10.4).
        """
        K = self.absorption
        S = self.scattering
        return S / np.maximum(2 * (K + S), TINY)


def from_opaque(reflectance: ArrayLike, scattering: Scattering) -> Pigment:
    """Derive K and S from the reflectance (..., N) of opaque paint (eq. 10.6)."""
    R = np.clip(np.asarray(reflectance, dtype=float), DARKEST, 1)
    S = scattering(R)
    return Pigment(S * ((1 - R) ** 2 / (2 * R)), S)


def from_black_and_white(on_black: ArrayLike, on_white: ArrayLike) -> Pigment:
    """Derive K and S from the reflectances (..., N) of a layer of unit thickness on
    black and on white.

    Paint on white has R = R₀ + T² / (1 − R₀). With the absorptance A = 1 − R₀ − T: cosh
    γ = 1 + A (A + 2R₀) / 2T, S = γ R₀ / (T sinh γ) and K = γ A (1 − R₀ + T) / (2T sinh
    γ). These forms do not cancel for S → 0 or K → 0. Raises `ColourError` if no paint
    has both reflectances, or if they do not differ enough.
    """
    R0 = np.asarray(on_black, dtype=float)
    R1 = np.asarray(on_white, dtype=float)
    T = np.sqrt(np.maximum(R1 - (1 + R1) * R0 + R0**2, 0))
    if not (T > MIN_TRANSMITTANCE).all():
        problem = "the layer hides the ground, or is lighter on the darker ground"
        raise ColourError(problem, hint="measure a thinner layer")
    if not ((R0 >= -SLACK) & (R0 + T <= 1 + SLACK)).all():
        problem = "no paint has these reflectances on these grounds"
        raise ColourError(problem, hint="check the order of the grounds")
    R0 = np.maximum(R0, 0)
    A = np.maximum(1 - R0 - T, 0)
    cosh_minus_1 = A * (A + 2 * R0) / (2 * T)
    sinh = np.sqrt(cosh_minus_1 * (cosh_minus_1 + 2))
    safe = np.where(sinh > 0, sinh, 1)
    ratio = np.where(sinh > 0, np.log1p(cosh_minus_1 + sinh) / safe, 1) / T
    return Pigment(ratio * A * (1 - R0 + T) / 2, ratio * R0)
