"""Validation of amounts, and weighted sums of spectra."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

MAX_LENGTH = 1e9
"""Limit of thicknesses, concentrations and gradings, which are multiplied with each other."""


def as_amounts(parts: ArrayLike) -> Array:
    """Return parts (…, n) as floats. Raises `OptionError` (``invalid-parts``) unless finite and not negative."""
    array = np.asarray(parts, dtype=float)
    if array.ndim == 0 or not (np.isfinite(array) & (array >= 0)).all():
        raise OptionError(
            f"parts of a mixture must be a sequence of finite numbers of at least 0, got {array.tolist()}",
            code="invalid-parts",
            hint="pass one for each component",
        )
    return array


def as_shares(parts: ArrayLike) -> Array:
    """Return parts (…, n) scaled to sum 1. Raises `OptionError` (``invalid-parts``), also if all are 0."""
    array = as_amounts(parts)
    largest = array.max(axis=-1, keepdims=True)
    if not (largest > 0).all():
        raise OptionError(
            "some part of a mixture must be greater than 0", code="invalid-parts", hint="raise one of them"
        )
    relative = array / largest  # a sum of huge parts would overflow
    return np.asarray(relative / relative.sum(axis=-1, keepdims=True))


def as_length(value: float, name: str = "thickness", code: str = "invalid-thickness") -> float:
    """Return a number from 0 to `MAX_LENGTH`. Raises `OptionError` with ``code``."""
    if not 0 <= value <= MAX_LENGTH:
        raise OptionError(f"{name} must be in [0, {MAX_LENGTH:g}], got {value}", code=code, hint="1 is the unit")
    return float(value)


def weighted_sum(spectra: ArrayLike, weights: Array) -> Array:
    """Return the sum (…, N) of spectra (…, n, N) with weights (…, n)."""
    return np.asarray((weights[..., None, :] @ np.asarray(spectra, dtype=float))[..., 0, :])
