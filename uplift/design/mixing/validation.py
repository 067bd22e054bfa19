"""Amounts of what is mixed, checked; sums and means over them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError


def amounts(parts: ArrayLike) -> Array:
    """Parts (…, n) as floats. Raises `OptionError` for negative ones and NaN."""
    array = np.asarray(parts, dtype=float)
    if array.ndim == 0 or not (np.isfinite(array) & (array >= 0)).all():
        raise OptionError("parts of a mixture are numbers from 0 up", hint="give one for each colour")
    return array


def shares(parts: ArrayLike) -> Array:
    """Parts (…, n) that sum to 1. Raises `OptionError`, also where there is nothing to share."""
    array = amounts(parts)
    total = array.sum(axis=-1, keepdims=True)
    if not (total > 0).all():
        raise OptionError("a mixture of no parts", hint="give some part more than 0")
    return np.asarray(array / total)


def length(value: float, what: str = "thickness") -> float:
    """A finite number from 0 up. Raises `OptionError`."""
    if not (np.isfinite(value) and value >= 0):
        raise OptionError(f"{what} {value} is no number from 0 up", hint="0 is none, 1 the unit")
    return float(value)


def summed(spectra: ArrayLike, weights: Array) -> Array:
    """Spectra (…, n, N) weighted (…, n) and summed: (…, N)."""
    return np.asarray((weights[..., None, :] @ np.asarray(spectra, dtype=float))[..., 0, :])
