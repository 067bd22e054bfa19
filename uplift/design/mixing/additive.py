"""Additive mixture: superposed lights, and dots too small to resolve.

Both are linear. Results are therefore the same in spectra, XYZ and linear RGB (Grassmann's law).

References
----------
K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, eq. 8.1–8.3.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.validation import as_amounts, as_shares, weighted_sum


def add_lights(spectra: ArrayLike, strengths: ArrayLike) -> Array:
    """Superpose lights (eq. 8.1, 8.2).

    Parameters
    ----------
    spectra : array_like of shape (..., n, N)
        Spectral power of each light.
    strengths : array_like of shape (..., n)
        Factors of at least 0.

    Returns
    -------
    ndarray of shape (..., N)
        Spectral power of the sum.
    """
    return weighted_sum(spectra, as_amounts(strengths))


def average_areas(spectra: ArrayLike, parts: ArrayLike) -> Array:
    """Average small dots by the areas that they cover (eq. 8.3).

    Parameters
    ----------
    spectra : array_like of shape (..., n, N)
        Reflectance of each kind of dot.
    parts : array_like of shape (..., n)
        Areas in any unit.

    Returns
    -------
    ndarray of shape (..., N)
        Mean reflectance.
    """
    return weighted_sum(spectra, as_shares(parts))
