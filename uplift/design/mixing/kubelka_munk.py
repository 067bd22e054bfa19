"""Kubelka and Munk: light goes down and up through what absorbs (K) and scatters (S) it, per unit thickness.

P. Kubelka & F. Munk 1931; P. Kubelka 1948, J. Opt. Soc. Am. 38, with a ground (10.11). With γ = √(K (K + 2S)) a
layer of thickness X has (10.2)

    T = γ / Δ,    R = S sinh γX / Δ,    Δ = (K + S) sinh γX + γ cosh γX,

here divided by γ e^γX, so that nothing overflows and K → 0 and S → 0 need no care. On a ground it is (10.11).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.mixing.layers import LEAST, Layer
from uplift.design.mixing.pigments import Pigment


def hiding(pigment: Pigment) -> Array:
    """Reflectance (…, N) of paint that hides its ground: X → ∞ (10.5). Nothing comes back where S = 0."""
    K, S = pigment.absorption, pigment.scattering
    return np.asarray(S / np.maximum(K + S + _gamma(K, S), LEAST))


def layer(pigment: Pigment, thickness: ArrayLike) -> Layer:
    """Paint of a thickness (…), in units of 1/K and 1/S (10.2). Raises `OptionError` unless finite and not negative."""
    X = np.asarray(thickness, dtype=float)[..., None]
    if not (np.isfinite(X) & (X >= 0)).all():
        raise OptionError("a layer's thickness is a number from 0 up", hint="hiding paint has none to give")
    K, S = pigment.absorption, pigment.scattering
    gamma = _gamma(K, S)
    path = 2 * gamma * X
    sinh = np.where(path > 0, -np.expm1(-path) / np.maximum(2 * gamma, LEAST), X)
    cosh = (1 + np.exp(-path)) / 2
    delta = (K + S) * sinh + cosh
    return Layer(S * sinh / delta, np.exp(-path / 2) / delta)


def _gamma(K: Array, S: Array) -> Array:
    return np.sqrt(K * (K + 2 * S))
