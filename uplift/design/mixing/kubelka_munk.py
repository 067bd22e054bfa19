"""Kubelka and Munk's two-flux theory: layers that absorb (K) and scatter (S), per unit thickness.

With γ = √(K (K + 2S)) a layer of thickness X has (Fishkin 1983, eq. 10.2)

    T = γ / Δ,    R = S sinh γX / Δ,    Δ = (K + S) sinh γX + γ cosh γX.

Numerators and denominators are divided by γ e^γX here, which prevents overflow and covers K → 0 and S → 0. The result
on a ground is eq. 10.11 (`Layer.over`).

References
----------
P. Kubelka and F. Munk, Zeitschrift für technische Physik 12, 1931; P. Kubelka, J. Opt. Soc. Am. 38, 1948.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.mixing.layers import TINY, Layer
from uplift.design.mixing.pigments import Pigment


def opaque_reflectance(pigment: Pigment) -> Array:
    """Return the reflectance of opaque paint, the limit X → ∞ (eq. 10.5).

    Parameters
    ----------
    pigment : Pigment
        Absorption and scattering (..., N).

    Returns
    -------
    ndarray of shape (..., N)
        Reflectance in [0, 1]; 0 without scattering.

    Examples
    --------
    >>> import numpy as np
    >>> from uplift.design.mixing.pigments import Pigment
    >>> opaque_reflectance(Pigment(np.array([1.0]), np.array([4.0]))).tolist()
    [0.5]
    """
    K, S = pigment.absorption, pigment.scattering
    return np.asarray(S / np.maximum(K + S + _gamma(K, S), TINY))


def layer(pigment: Pigment, thickness: ArrayLike) -> Layer:
    """Return the optical properties of a layer of paint (eq. 10.2).

    Parameters
    ----------
    pigment : Pigment
        Absorption and scattering (..., N).
    thickness : array_like of shape (...)
        Thickness X in units of 1/K and 1/S, finite and at least 0.

    Returns
    -------
    Layer
        Reflectance on black and transmittance.

    Raises
    ------
    OptionError
        The thickness is negative or not finite (code ``invalid-thickness``).
    """
    X = np.asarray(thickness, dtype=float)[..., None]
    if not (np.isfinite(X) & (X >= 0)).all():
        raise OptionError(
            f"thickness must be finite and at least 0, got {np.squeeze(X).tolist()}",
            code="invalid-thickness",
            hint="use opaque_reflectance for opaque paint",
        )
    K, S = pigment.absorption, pigment.scattering
    gamma = _gamma(K, S)
    path = 2 * gamma * X
    sinh = np.where(path > 0, -np.expm1(-path) / np.maximum(2 * gamma, TINY), X)
    cosh = (1 + np.exp(-path)) / 2
    delta = (K + S) * sinh + cosh
    return Layer(S * sinh / delta, np.exp(-path / 2) / delta)


def _gamma(K: Array, S: Array) -> Array:
    return np.sqrt(K * (K + 2 * S))
