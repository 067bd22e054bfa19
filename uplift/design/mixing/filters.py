"""Filters one behind the other (9.1): what each lets through is multiplied (Bouguer, Lambert, Beer)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing.validation import amounts


def stacked(transmittance: ArrayLike, thickness: ArrayLike) -> Array:
    """Transmittance (…, N) of filters (…, n, N), each given for unit thickness, that are ``thickness`` (…, n) thick.

    Nothing is reflected between them. What light is sent through may be multiplied on, or stand as one more filter.
    """
    powers = amounts(thickness)[..., None]
    return np.prod(np.asarray(transmittance, dtype=float) ** powers, axis=-2)
