"""Oklab, in which lines of one hue are nearly straight: Ottosson 2020, "A perceptual color space for image processing".

L is 0 for black and 1 for white, a and b are 0 for grey. numpy alone.
"""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.gamut.boundary import Gamut
from uplift.common.arrays import Array

CONES = np.array(
    [
        [0.8189330101, 0.3618667424, -0.1288597137],
        [0.0329845436, 0.9293118715, 0.0361456387],
        [0.0482003018, 0.2643662691, 0.6338517070],
    ]
)
"""XYZ under D65 to responses of cones."""
OPPONENTS = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""Cube roots of these to L, a, b."""


def responses(gamut: Gamut) -> Array:
    """(3, 3) linear RGB to responses of cones, which are (1, 1, 1) for the gamut's own white: the eye adapts to it."""
    matrix = CONES @ gamut.rgb_to_xyz
    return np.asarray(matrix / matrix.sum(axis=1, keepdims=True))


def oklab(rgb: Array, gamut: Gamut) -> Array:
    """L, a, b (…, 3) of linear RGB (…, 3)."""
    return np.asarray(np.cbrt(rgb @ responses(gamut).T) @ OPPONENTS.T)


def roots(lab: Array) -> Array:
    """Cube roots (…, 3) of the responses of cones, of L, a, b (…, 3)."""
    return np.asarray(lab @ np.linalg.inv(OPPONENTS).T)
