"""Stacked filters: transmittances are multiplied (Bouguer, Lambert, Beer; Fishkin 1983, eq. 9.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.validation import as_amounts


def stack(transmittance: ArrayLike, thickness: ArrayLike) -> Array:
    """Return the transmittance of a stack of filters, without reflections between them.

    Parameters
    ----------
    transmittance : array_like of shape (..., n, N)
        Transmittance of each filter at unit thickness. A light source can take the place of a filter.
    thickness : array_like of shape (..., n)
        Thickness of each filter, at least 0.

    Returns
    -------
    ndarray of shape (..., N)
        Transmittance of the stack.
    """
    powers = as_amounts(thickness)[..., None]
    return np.prod(np.asarray(transmittance, dtype=float) ** powers, axis=-2)
