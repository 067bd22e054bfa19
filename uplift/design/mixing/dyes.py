"""Dyes: dissolved, so that they absorb and do not scatter (9.3–9.7).

**(9.7) anew.** Of the light, ρ is thrown back at the surface, 1 − ρ goes in. It crosses the layer (T), meets a
ground in contact with it (R_g), crosses the layer again (T); there 1 − ρ_i of it leaves and ρ_i is thrown back
inside, to do the same again. What leaves after the i-th time is (1 − ρ) (1 − ρ_i) (T² R_g)^i ρ_i^(i−1), so that

    R = ρ + (1 − ρ) (1 − ρ_i) T² R_g Σ_{i≥0} (ρ_i T² R_g)^i = ρ + (1 − ρ) (1 − ρ_i) T² R_g / (1 − ρ_i T² R_g).

The thesis, with ρ_i = ρ, prints (1 − ρ)² / (ρ (1 − ρ T² R_g)): its sum starts at 1, and the term with i = 0 was not
taken away again, so that the numerator lacks ρ T² R_g, the only one that the ground is in; its R is above 1 for
every small ρ. The right one is Saunderson's correction (10.10) of T² R_g, which is what Kubelka and Munk give
without scattering.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.surface import NONE, Surface
from uplift.design.mixing.validation import length, shares, summed

DARKEST = 1e-6
"""Least transmittance that an absorption is told from; less would be without limit."""


def transmittance(absorption: ArrayLike, concentration: float = 1.0, thickness: float = 1.0) -> Array:
    """T (…, N) = exp(−c K X) of absorption K (…, N) per unit of both (9.5: Beer, Bouguer)."""
    amount = length(concentration, "concentration") * length(thickness)
    return np.exp(-amount * np.asarray(absorption, dtype=float))


def absorption(transmittance: ArrayLike) -> Array:
    """K (…, N) of what lets through (…, N) at unit concentration and thickness: (9.5) turned round."""
    return -np.log(np.clip(np.asarray(transmittance, dtype=float), DARKEST, 1))


def mixed(absorption: ArrayLike, parts: ArrayLike) -> Array:
    """K (…, N) of ``parts`` (…, n) of dyes (…, n, N), the medium being one of them if it absorbs: their mean."""
    return summed(absorption, shares(parts))


def plate(transmittance: ArrayLike, rho: float) -> Layer:
    """A sheet with two surfaces that throw back ``rho`` each, nothing in contact behind it (9.4)."""
    once = np.asarray(transmittance, dtype=float)
    leaving = 1 - (rho * once) ** 2
    return Layer(rho + rho * ((1 - rho) * once) ** 2 / leaving, (1 - rho) ** 2 * once / leaving)


def in_contact(transmittance: ArrayLike, ground: ArrayLike, surface: Surface = NONE) -> Array:
    """Reflectance (…, N) of a dye upon a ground (…, N) that it wets (9.7, as derived above)."""
    return surface.seen(np.asarray(transmittance, dtype=float) ** 2 * np.asarray(ground, dtype=float))


def of_reflectance(reflectance: ArrayLike, surface: Surface = NONE) -> Array:
    """K (…, N) of a dye that on a perfect white, at unit concentration and thickness, is seen with this reflectance."""
    return absorption(np.sqrt(np.clip(surface.beneath(reflectance), 0, 1)))
