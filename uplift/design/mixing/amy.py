"""Amy's approximation of a layer of paint on black, for strong absorption: (K + S)² ≫ S².

For white paint the reflectance is half of the exact one. It serves as a comparison.

References
----------
L. Amy, Revue d'Optique 16(3), 1937; Fishkin 1983, eq. 10.3, 10.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.layers import TINY, Layer
from uplift.design.mixing.pigments import Pigment


def layer(pigment: Pigment, thickness: ArrayLike) -> Layer:
    """Return the optical properties of a layer of paint (eq. 10.3).

    γ is replaced by K + S, except in the exponent of the reflectance, as in Fishkin 1983.

    Parameters
    ----------
    pigment : Pigment
        Absorption and scattering (..., N).
    thickness : array_like of shape (...)
        Thickness in units of 1/K and 1/S.

    Returns
    -------
    Layer
        Reflectance on black and transmittance.
    """
    K, S = pigment.absorption, pigment.scattering
    X = np.asarray(thickness, dtype=float)[..., None]
    gamma = np.sqrt(K * (K + 2 * S))
    return Layer(opaque_reflectance(pigment) * -np.expm1(-2 * gamma * X), np.exp(-(K + S) * X))


def opaque_reflectance(pigment: Pigment) -> Array:
    """Return the reflectance of opaque paint (eq. 10.4).

    Parameters
    ----------
    pigment : Pigment
        Absorption and scattering (..., N).

    Returns
    -------
    ndarray of shape (..., N)
        Reflectance in [0, 1/2].
    """
    K, S = pigment.absorption, pigment.scattering
    return np.asarray(S / np.maximum(2 * (K + S), TINY))
