"""The thesis's paint heuristic (10.4): the centre of gravity in HSL, on a wheel of red, yellow and blue.

The solid is the double cone that the thesis's reasons ask for (figure 10.3): radius = chroma, so that lines to
black and to white keep hue and saturation. Two slips of the printed hue map are mended. Its middle third subtracts
1/3 where only adding leads from yellow (1/6 → 1/3) on. Its slope of 1/2 then ends at 7/12 and leaps to 2/3 at blue,
so that the map has no inverse; 2/3 is the slope that joins both ends. Green, 1/3, comes to lie at 4/9: red and
green are not quite opposite.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing import hsl
from uplift.design.mixing.validation import shares, summed

RGB_WHEEL = (0.0, 1 / 6, 2 / 3, 1.0)
RYB_WHEEL = (0.0, 1 / 3, 2 / 3, 1.0)
"""Hues of red, yellow, blue and red again."""


def mixed(rgb: ArrayLike, parts: ArrayLike) -> Array:
    """RGB (…, 3) of ``parts`` (…, n) of paints (…, n, 3) in [0, 1]."""
    return _from_solid(summed(_to_solid(np.asarray(rgb, dtype=float)), shares(parts)))


def _to_solid(rgb: Array) -> Array:
    hue, _, lightness = np.moveaxis(hsl.from_rgb(rgb), -1, 0)
    angle = 2 * np.pi * np.interp(hue, RGB_WHEEL, RYB_WHEEL)
    chroma = rgb.max(axis=-1) - rgb.min(axis=-1)
    return np.stack([chroma * np.cos(angle), chroma * np.sin(angle), lightness], axis=-1)


def _from_solid(point: Array) -> Array:
    across, up, lightness = np.moveaxis(point, -1, 0)
    hue = np.interp(np.arctan2(up, across) / (2 * np.pi) % 1, RYB_WHEEL, RGB_WHEEL)
    room = np.minimum(2 * lightness, 2 - 2 * lightness)
    saturation = np.where(room > 0, np.hypot(across, up) / np.where(room > 0, room, 1), 0)
    return hsl.to_rgb(np.stack([hue, np.minimum(saturation, 1), lightness], axis=-1))
