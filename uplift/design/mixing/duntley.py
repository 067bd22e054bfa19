"""Duntley's eight constants: the beam that comes in and the diffuse light within fare differently.

S. Q. Duntley 1942, J. Opt. Soc. Am. 32(2); 10.8. Of the beam, K' is absorbed per unit thickness, B' scattered back
and F' on; of diffuse light K, B and F; S' = B' + F' and S = B + F make eight names. F has no part in the answer:
what diffuse light scatters on stays what it was. With μ = K' + B' + F' and γ² = K (K + 2B), the beam e^−μx feeds
two diffuse fluxes,

    t' = F' e^−μx − (K + B) t + B s,    −s' = B' e^−μx − (K + B) s + B t,    t(0) = 0,  s(X) = 0.

−Q' e^−μx and −P' e^−μx are one solution, and what is left is Kubelka and Munk's with S = B, on which Q' falls from
above and P' e^−μX from below. So, with their r and τ of the layer,

    R = Q' r + P' e^−μX τ − P',    T = Q' τ + P' e^−μX r − (Q' − 1) e^−μX,

which is (10.8) as printed. P' and Q' have μ² − γ² below; where that is 0 both limits exist, and are taken from both
sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.design.mixing import kubelka_munk
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.pigments import Pigment

NEAR = 1e-5
"""How near, in parts, μ and γ may come before the mean of both sides is taken: it is off by the square."""


@dataclass(frozen=True, eq=False)
class Flux:
    """Of light, per unit thickness: ``absorption``, scattering ``backward`` and ``forward``, (…, N) each."""

    absorption: Array
    backward: Array
    forward: Array


def layer(beam: Flux, diffuse: Flux, thickness: float) -> Layer:
    """What of a beam comes out above, as diffuse light (R), and below, the rest of it included (T) (10.8)."""
    mu = beam.absorption + beam.backward + beam.forward
    gamma = np.sqrt(diffuse.absorption * (diffuse.absorption + 2 * diffuse.backward))
    step = NEAR * np.maximum(mu, gamma)
    close = np.abs(mu - gamma) < step
    off = np.where(close, 2 * step, 0.0)
    above, below = (_layer(_moved(beam, side * off), diffuse, thickness) for side in (1, -1))
    return Layer((above.reflectance + below.reflectance) / 2, (above.transmittance + below.transmittance) / 2)


def _moved(beam: Flux, by: Array) -> Flux:
    return Flux(beam.absorption + by, beam.backward, beam.forward)


def _layer(beam: Flux, diffuse: Flux, thickness: float) -> Layer:
    within = kubelka_munk.layer(Pigment(diffuse.absorption, diffuse.backward), thickness)
    r, tau = within.reflectance, within.transmittance
    beam_left = np.exp(-(beam.absorption + beam.backward + beam.forward) * thickness)
    P, Q = _sources(beam, diffuse)
    return Layer(Q * r + P * beam_left * tau - P, Q * tau + P * beam_left * r - (Q - 1) * beam_left)


def _sources(beam: Flux, diffuse: Flux) -> tuple[Array, Array]:
    """P' and Q'; a beam that is not scattered feeds nothing."""
    K, B = diffuse.absorption, diffuse.backward
    K1, B1, F1 = beam.absorption, beam.backward, beam.forward
    S1 = B1 + F1
    below = (K1 + S1) ** 2 - K * (K + 2 * B)
    safe = np.where(below == 0, 1, below)
    P = ((K - K1) * B1 + (B - B1) * S1) / safe
    Q = ((K + K1) * F1 + (B + F1) * S1) / safe
    return np.where(S1 > 0, P, 0), np.where(S1 > 0, Q, 0)
