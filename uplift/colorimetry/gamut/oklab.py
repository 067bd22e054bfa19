"""Oklab: a perceptual colour space in which lines of constant hue are nearly straight.

Ottosson 2020, "A perceptual color space for image processing". L is 0 for black and 1 for white, a and b are 0 for
grey.
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
"""XYZ under D65 to cone responses."""
OPPONENTS = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""Cube roots of cone responses to L, a, b."""


def cone_responses(gamut: Gamut) -> Array:
    """Matrix (3, 3) from linear RGB to cone responses, adapted so that the white of the gamut gives (1, 1, 1)."""
    matrix = CONES @ gamut.rgb_to_xyz
    return np.asarray(matrix / matrix.sum(axis=1, keepdims=True))


def oklab(rgb: Array, gamut: Gamut) -> Array:
    """Convert linear RGB (…, 3) to L, a, b (…, 3)."""
    return np.asarray(np.cbrt(rgb @ cone_responses(gamut).T) @ OPPONENTS.T)


def cube_roots(lab: Array) -> Array:
    """Convert L, a, b (…, 3) to cube roots of cone responses (…, 3)."""
    return np.asarray(lab @ np.linalg.inv(OPPONENTS).T)
