"""Paint heuristic of Fishkin 1983, section 10.4: the centroid in HSL on a wheel of red, yellow and blue.

The solid is the double cone of figure 10.3, whose radius is chroma. Lines to black and white therefore keep hue and
saturation. Two errors in the printed hue map are corrected:

- Its middle third subtracts 1/3, but only adding 1/3 continues from yellow (1/6 → 1/3).
- Its slope of 1/2 ends at 7/12 and jumps to 2/3 at blue, so the map is not invertible. A slope of 2/3 joins both ends.

Green, 1/3, maps to 4/9, so red and green are not exactly opposite.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing import hsl
from uplift.design.mixing.validation import as_shares, weighted_sum

RGB_WHEEL = (0.0, 1 / 6, 2 / 3, 1.0)
RYB_WHEEL = (0.0, 1 / 3, 2 / 3, 1.0)
"""Hues of red, yellow, blue and red again."""


def mix(rgb: ArrayLike, parts: ArrayLike) -> Array:
    """Mix colours as paints.

    Parameters
    ----------
    rgb : array_like of shape (..., n, 3)
        RGB in [0, 1].
    parts : array_like of shape (..., n)
        Amounts.

    Returns
    -------
    ndarray of shape (..., 3)
        RGB of the mixtures.
    """
    return _from_solid(weighted_sum(_to_solid(np.asarray(rgb, dtype=float)), as_shares(parts)))


def _to_solid(rgb: Array) -> Array:
    hue, _, lightness = np.moveaxis(hsl.from_rgb(rgb), -1, 0)
    angle = 2 * np.pi * np.interp(hue, RGB_WHEEL, RYB_WHEEL)
    chroma = rgb.max(axis=-1) - rgb.min(axis=-1)
    return np.stack([chroma * np.cos(angle), chroma * np.sin(angle), lightness], axis=-1)


def _from_solid(point: Array) -> Array:
    x, y, lightness = np.moveaxis(point, -1, 0)
    hue = np.interp(np.arctan2(y, x) / (2 * np.pi) % 1, RYB_WHEEL, RGB_WHEEL)
    max_chroma = np.minimum(2 * lightness, 2 - 2 * lightness)
    saturation = np.where(max_chroma > 0, np.hypot(x, y) / np.where(max_chroma > 0, max_chroma, 1), 0)
    return hsl.to_rgb(np.stack([hue, np.minimum(saturation, 1), lightness], axis=-1))
