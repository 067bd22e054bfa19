"""Duntley's theory with eight constants: collimated incident light and diffuse light within a layer differ.

Per unit thickness, a fraction K' of the beam is absorbed, B' is scattered backward and F' forward; K, B and F are those
of diffuse light (F has no effect), S' = B' + F' and S = B + F. With μ = K' + B' + F' and γ² = K (K + 2B), the beam
e^−μx feeds two diffuse fluxes,

    t' = F' e^−μx − (K + B) t + B s,    −s' = B' e^−μx − (K + B) s + B t,    t(0) = 0,  s(X) = 0.

−Q' e^−μx and −P' e^−μx are a particular solution. The rest is Kubelka and Munk's layer (r, τ) with S = B, so that

    R = Q' r + P' e^−μX τ − P',    T = Q' τ + P' e^−μX r − (Q' − 1) e^−μX,

which is eq. 10.8 of Fishkin 1983. Where the denominator μ² − γ² of P' and Q' vanishes, the mean of both sides is taken.
Particles that scatter in all directions alike leave two constants (`isotropic`). S. Q. Duntley, J. Opt. Soc. Am. 1942.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.pigments import Pigment

# Relative difference of μ and γ below which the mean of both sides is taken; its error is the square of this.
MIN_RELATIVE_GAP = 1e-5


@dataclass(frozen=True, eq=False)
class Flux:
    """Fractions (..., N) of a kind of light that are absorbed, scattered backward and forward per unit thickness."""

    absorption: Array
    backward: Array
    forward: Array

    @property
    def attenuation(self) -> Array:
        """Sum of all three (..., N), μ of a beam."""
        return self.absorption + self.backward + self.forward


def isotropic(pigment: Pigment) -> tuple[Flux, Flux]:
    """Derive the constants of beam and diffuse light for a pigment that scatters in all directions alike."""
    K, S = pigment.absorption, pigment.scattering
    return Flux(K / 2, S / 2, S / 2), Flux(K, S, S)


def directed_reflectance(diffuse: ArrayLike) -> Array:
    """Return the reflectance in a beam of an opaque, isotropic layer, R = 2r / (3 − r)."""
    r = np.asarray(diffuse, dtype=float)
    return 2 * r / (3 - r)


def diffuse_reflectance(directed: ArrayLike) -> Array:
    """Return the reflectance in diffuse light of an opaque, isotropic layer, r = 3R / (2 + R)."""
    R = np.asarray(directed, dtype=float)
    return 3 * R / (2 + R)


def layer(beam: Flux, diffuse: Flux, thickness: float) -> Layer:
    """Return the optical properties of a layer for collimated light (eq. 10.8)."""
    mu = beam.attenuation
    gamma = np.sqrt(diffuse.absorption * (diffuse.absorption + 2 * diffuse.backward))
    step = MIN_RELATIVE_GAP * np.maximum(mu, gamma)
    offset = np.where(np.abs(mu - gamma) < step, 2 * step, 0.0)
    sides = [Flux(beam.absorption + shift, beam.backward, beam.forward) for shift in (offset, -offset)]
    above, below = (_layer(side, diffuse, thickness) for side in sides)
    return Layer((above.reflectance + below.reflectance) / 2, (above.transmittance + below.transmittance) / 2)


def _layer(beam: Flux, diffuse: Flux, thickness: float) -> Layer:
    inner = Pigment(diffuse.absorption, diffuse.backward).layer(thickness)
    r, tau = inner.reflectance, inner.transmittance
    unscattered = np.exp(-beam.attenuation * thickness)
    P, Q = sources(beam, diffuse)
    return Layer(Q * r + P * unscattered * tau - P, Q * tau + P * unscattered * r - (Q - 1) * unscattered)


def sources(beam: Flux, diffuse: Flux) -> tuple[Array, Array]:
    """Return P' and Q', which are 0 for a beam that is not scattered."""
    K, B = diffuse.absorption, diffuse.backward
    K1, B1, F1 = beam.absorption, beam.backward, beam.forward
    S1 = B1 + F1
    denominator = (K1 + S1) ** 2 - K * (K + 2 * B)
    safe = np.where(denominator == 0, 1, denominator)
    P = ((K - K1) * B1 + (B - B1) * S1) / safe
    Q = ((K + K1) * F1 + (B + F1) * S1) / safe
    return np.where(S1 > 0, P, 0), np.where(S1 > 0, Q, 0)
