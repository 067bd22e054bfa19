"""Additive mixture (8.1–8.3): lights upon one another, and dots too small to be told apart.

Both are linear, so that they may be reckoned in spectra, in XYZ and in linear RGB alike (Grassmann).
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.validation import amounts, shares, summed


def lights(spectra: ArrayLike, strengths: ArrayLike) -> Array:
    """(…, N) of lights (…, n, N) shone on one another, each ``strengths`` (…, n) times itself (8.1, 8.2)."""
    return summed(spectra, amounts(strengths))


def dots(spectra: ArrayLike, parts: ArrayLike) -> Array:
    """(…, N) of surfaces (…, n, N) that cover ``parts`` (…, n) of a whole (8.3): their mean."""
    return summed(spectra, shares(parts))
