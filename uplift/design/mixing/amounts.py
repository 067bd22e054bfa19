"""Amounts of components, and the mixtures that need no more: superposed lights, small dots, stacked filters.

K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, eq. 8.1–8.3 and 9.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

MAX_LENGTH = 1e9  # limit of thicknesses, which are multiplied with other numbers


def as_amounts(parts: ArrayLike) -> Array:
    """Return parts (…, n) as floats. Raises `OptionError` unless they are finite and not negative."""
    array = np.asarray(parts, dtype=float)
    if array.ndim == 0 or not (np.isfinite(array) & (array >= 0)).all():
        raise OptionError(
            f"parts of a mixture must be a sequence of finite numbers of at least 0, got {array.tolist()}",
            hint="pass one for each component",
        )
    return array


def as_shares(parts: ArrayLike) -> Array:
    """Return parts (…, n) scaled to sum 1. Raises `OptionError`, also if all are 0."""
    array = as_amounts(parts)
    largest = array.max(axis=-1, keepdims=True)
    if not (largest > 0).all():
        raise OptionError("some part of a mixture must be greater than 0", hint="raise one of them")
    relative = array / largest  # a sum of huge parts would overflow
    return np.asarray(relative / relative.sum(axis=-1, keepdims=True))


def as_thickness(value: float) -> float:
    """Return a thickness from 0 to `MAX_LENGTH`. Raises `OptionError` for others."""
    if not 0 <= value <= MAX_LENGTH:
        problem = f"thickness must be in [0, {MAX_LENGTH:g}], got {value}"
        raise OptionError(problem, code="invalid-thickness", hint="1 is the unit")
    return float(value)


def weighted_sum(spectra: ArrayLike, weights: Array) -> Array:
    """Return the sum (…, N) of spectra (…, n, N) with weights (…, n)."""
    return np.asarray((weights[..., None, :] @ np.asarray(spectra, dtype=float))[..., 0, :])


def add_lights(spectra: ArrayLike, strengths: ArrayLike) -> Array:
    """Superpose lights (…, n, N) of some strengths (…, n) (eq. 8.1, 8.2): linear in spectra, XYZ and linear RGB."""
    return weighted_sum(spectra, as_amounts(strengths))


def average_areas(spectra: ArrayLike, parts: ArrayLike) -> Array:
    """Average the reflectances (…, n, N) of dots too small to resolve by the areas (…, n) that they cover (eq. 8.3)."""
    return weighted_sum(spectra, as_shares(parts))


def stack_filters(transmittance: ArrayLike, thickness: ArrayLike) -> Array:
    """Multiply transmittances (…, n, N), each to the power of its thickness (…, n), without reflections (eq. 9.1)."""
    powers = as_amounts(thickness)[..., None]
    return np.prod(np.asarray(transmittance, dtype=float) ** powers, axis=-2)
