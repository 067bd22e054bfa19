"""Hue, saturation and lightness of RGB, vectorised.

All values are in [0, 1], for RGB of any kind. Hue 0 is red, 1/3 green, 2/3 blue.

References
----------
GSPC, "Status Report of the Graphics Standards Planning Committee" (Core), 1979; Fishkin 1983, section 5.3.5.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array

SEXTANTS = np.array([[0, 1, 2], [3, 0, 2], [2, 0, 1], [2, 3, 0], [1, 2, 0], [0, 2, 3]])
"""For each sixth of the hues: indices of red, green and blue among (largest, rising, smallest, falling)."""


def to_rgb(hsl: ArrayLike) -> Array:
    """Convert hue, saturation and lightness to RGB.

    The largest and the smallest component follow from lightness and saturation as in HSL, the third as in HSV. Only
    the sixth of the hue circle that contains the hue is computed (Fishkin 1983, 5.3.5).

    Parameters
    ----------
    hsl : array_like of shape (..., 3)
        Hue, with period 1, saturation and lightness.

    Returns
    -------
    ndarray of shape (..., 3)
        RGB.
    """
    hue, saturation, lightness = np.moveaxis(np.asarray(hsl, dtype=float), -1, 0)
    largest = np.where(lightness <= 0.5, lightness * (1 + saturation), lightness + saturation - lightness * saturation)
    smallest = 2 * lightness - largest
    position = 6 * (hue % 1)
    sextant = np.minimum(position.astype(int), 5)  # −1e-17 % 1 is 1
    change = (largest - smallest) * (position - sextant)
    values = np.stack([largest, smallest + change, smallest, largest - change], axis=-1)
    return np.take_along_axis(values, SEXTANTS[sextant], axis=-1)


def from_rgb(rgb: ArrayLike) -> Array:
    """Convert RGB to hue, saturation and lightness.

    Parameters
    ----------
    rgb : array_like of shape (..., 3)
        RGB in [0, 1].

    Returns
    -------
    ndarray of shape (..., 3)
        Hue, saturation and lightness. Greys have hue and saturation 0.
    """
    rgb = np.asarray(rgb, dtype=float)
    largest, smallest = rgb.max(axis=-1), rgb.min(axis=-1)
    chroma, lightness = largest - smallest, (largest + smallest) / 2
    max_chroma = np.minimum(2 * lightness, 2 - 2 * lightness)
    red, green, blue = np.moveaxis(rgb, -1, 0)
    safe = np.where(chroma > 0, chroma, 1)
    position = np.select(
        [largest == red, largest == green],
        [(green - blue) / safe % 6, (blue - red) / safe + 2],
        (red - green) / safe + 4,
    )
    saturation = np.where(max_chroma > 0, chroma / np.where(max_chroma > 0, max_chroma, 1), 0)
    return np.stack([np.where(chroma > 0, position / 6 % 1, 0), saturation, lightness], axis=-1)
