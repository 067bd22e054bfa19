"""Dyes: dissolved colorants, which absorb and do not scatter (Fishkin 1983, eq. 9.3–9.7).

**Derivation of eq. 9.7.** The surface reflects a fraction ρ of the light, and 1 − ρ enters. The light crosses the layer
(T), is reflected by a ground in optical contact (R_g), and crosses the layer again (T). There 1 − ρ_i leaves, and ρ_i
is reflected back for another pass. The i-th pass contributes (1 − ρ) (1 − ρ_i) (T² R_g)^i ρ_i^(i−1), so that

    R = ρ + (1 − ρ) (1 − ρ_i) T² R_g Σ_{i≥0} (ρ_i T² R_g)^i = ρ + (1 − ρ) (1 − ρ_i) T² R_g / (1 − ρ_i T² R_g).

The thesis, with ρ_i = ρ, prints (1 − ρ)² / (ρ (1 − ρ T² R_g)). Its sum starts at 1, but the term i = 0 was not
subtracted, so the numerator lacks ρ T² R_g, and R exceeds 1 for every small ρ. The correct result is Saunderson's
correction (eq. 10.10) of T² R_g, which is Kubelka and Munk's result without scattering.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.surface import NO_SURFACE, Surface
from uplift.design.mixing.validation import as_length, as_shares, weighted_sum

DARKEST = 1e-6
"""Smallest transmittance that absorption is derived from; it diverges at 0."""


def transmittance(absorption: ArrayLike, concentration: float = 1.0, thickness: float = 1.0) -> Array:
    """Return the transmittance T = exp(−c K X) of a dye (Beer and Bouguer, eq. 9.5).

    Parameters
    ----------
    absorption : array_like of shape (..., N)
        Absorption K at unit concentration, per unit thickness.
    concentration, thickness : float
        c and X, at least 0.

    Returns
    -------
    ndarray of shape (..., N)
        Transmittance in [0, 1].
    """
    amount = as_length(concentration, "concentration", code="invalid-concentration") * as_length(thickness)
    return np.exp(-amount * np.asarray(absorption, dtype=float))


def absorption(transmittance: ArrayLike) -> Array:
    """Return the absorption K from the transmittance at unit concentration and thickness (inverse of eq. 9.5).

    Parameters
    ----------
    transmittance : array_like of shape (..., N)
        Transmittance in [0, 1]; values below `DARKEST` are raised to it.

    Returns
    -------
    ndarray of shape (..., N)
        Absorption.
    """
    return -np.log(np.clip(np.asarray(transmittance, dtype=float), DARKEST, 1))


def mix(absorption: ArrayLike, parts: ArrayLike) -> Array:
    """Return the absorption of a mixture, the mean by parts.

    Parameters
    ----------
    absorption : array_like of shape (..., n, N)
        Absorption of the dyes, and of the medium if it absorbs.
    parts : array_like of shape (..., n)
        Amounts.

    Returns
    -------
    ndarray of shape (..., N)
        Absorption of the mixture.
    """
    return weighted_sum(absorption, as_shares(parts))


def plate(transmittance: ArrayLike, rho: float) -> Layer:
    """Return the optical properties of a free sheet with two surfaces (eq. 9.4).

    Parameters
    ----------
    transmittance : array_like of shape (..., N)
        Internal transmittance of one pass.
    rho : float
        Reflectance of each surface.

    Returns
    -------
    Layer
        Reflectance and transmittance of the sheet.
    """
    once = np.asarray(transmittance, dtype=float)
    denominator = 1 - (rho * once) ** 2
    return Layer(rho + rho * ((1 - rho) * once) ** 2 / denominator, (1 - rho) ** 2 * once / denominator)


def reflectance_on_ground(transmittance: ArrayLike, ground: ArrayLike, surface: Surface = NO_SURFACE) -> Array:
    """Return the reflectance of a dye in optical contact with a ground (eq. 9.7, as derived above).

    Parameters
    ----------
    transmittance : array_like of shape (..., N)
        Internal transmittance of one pass.
    ground : array_like of shape (..., N)
        Internal reflectance of the ground.
    surface : Surface
        Surface of the dye's vehicle.

    Returns
    -------
    ndarray of shape (..., N)
        Reflectance, surface included.
    """
    return surface.apply(np.asarray(transmittance, dtype=float) ** 2 * np.asarray(ground, dtype=float))


def from_reflectance(reflectance: ArrayLike, surface: Surface = NO_SURFACE) -> Array:
    """Return the absorption of a dye from its reflectance on perfect white at unit concentration and thickness.

    Parameters
    ----------
    reflectance : array_like of shape (..., N)
        Reflectance, surface included.
    surface : Surface
        Surface of the dye's vehicle.

    Returns
    -------
    ndarray of shape (..., N)
        Absorption.
    """
    return absorption(np.sqrt(np.clip(surface.remove(reflectance), 0, 1)))
