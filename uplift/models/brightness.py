"""The brightness of a colour, by which differences of spectra from expected ones grow
(docs/mathematics.md, 7).
"""

import numpy as np

from uplift.common.arrays import Array, largest

BRIGHTENING = 0.5
"""Power of max(x) that a colour is divided by: 0 leaves it unchanged, 1 makes it as
bright as possible.
"""
MIN_LEVEL = 1e-4


def brightness(rgb: Array) -> Array:
    """Factor k = max(x)^½ (n, 1) between linear RGB (n, 3) and brightened ones."""
    return np.maximum(largest(rgb), MIN_LEVEL)[:, None] ** BRIGHTENING
