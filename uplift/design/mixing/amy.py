"""Amy's approximations of a layer of paint on black (10.3, 10.4), for strong absorption: (K + S)² ≫ S².

L. Amy 1937, Revue d'Optique 16(3). For white paint they give half of what is right (R ≤ 1/2); kept to be compared.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.layers import LEAST, Layer
from uplift.design.mixing.pigments import Pigment


def layer(pigment: Pigment, thickness: ArrayLike) -> Layer:
    """Paint of a thickness (…) (10.3): γ → K + S, but for the exponent of R, where the thesis keeps it."""
    K, S = pigment.absorption, pigment.scattering
    X = np.asarray(thickness, dtype=float)[..., None]
    gamma = np.sqrt(K * (K + 2 * S))
    return Layer(hiding(pigment) * -np.expm1(-2 * gamma * X), np.exp(-(K + S) * X))


def hiding(pigment: Pigment) -> Array:
    """Reflectance (…, N) of thick paint (10.4)."""
    K, S = pigment.absorption, pigment.scattering
    return np.asarray(S / np.maximum(2 * (K + S), LEAST))
