"""Hue, saturation and lightness (Core 1979), and the thesis's way back to RGB (5.3.5), for arrays of colours.

All in [0, 1], of whatever RGB is given; hue 0 is red, 1/3 green, 2/3 blue.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array

CASES = np.array([[0, 1, 2], [3, 0, 2], [2, 0, 1], [2, 3, 0], [1, 2, 0], [0, 2, 3]])
"""Of each sixth of the hues, which of (most, rising, least, falling) red, green and blue are."""


def to_rgb(hsl: ArrayLike) -> Array:
    """RGB (…, 3) of hue, saturation, lightness (…, 3); hues repeat with period 1.

    Most and least of the three come from lightness and saturation as in HSL, the one between as in HSV: no sixth is
    worked out but the one that the hue lies in.
    """
    hue, saturation, lightness = np.moveaxis(np.asarray(hsl, dtype=float), -1, 0)
    most = np.where(
        lightness <= 0.5, lightness * (1 + saturation), lightness + saturation - lightness * saturation
    )
    least = 2 * lightness - most
    turned = 6 * (hue % 1)
    sixth = np.minimum(turned.astype(int), 5)  # −1e-17 % 1 is 1
    part = (most - least) * (turned - sixth)
    values = np.stack([most, least + part, least, most - part], axis=-1)
    return np.take_along_axis(values, CASES[sixth], axis=-1)


def from_rgb(rgb: ArrayLike) -> Array:
    """Hue, saturation, lightness (…, 3) of RGB (…, 3); greys have hue and saturation 0."""
    rgb = np.asarray(rgb, dtype=float)
    most, least = rgb.max(axis=-1), rgb.min(axis=-1)
    chroma, lightness = most - least, (most + least) / 2
    room = np.minimum(2 * lightness, 2 - 2 * lightness)
    red, green, blue = np.moveaxis(rgb, -1, 0)
    safe = np.where(chroma > 0, chroma, 1)
    turned = np.select(
        [most == red, most == green],
        [(green - blue) / safe % 6, (blue - red) / safe + 2],
        (red - green) / safe + 4,
    )
    saturation = np.where(room > 0, chroma / np.where(room > 0, room, 1), 0)
    return np.stack([np.where(chroma > 0, turned / 6 % 1, 0), saturation, lightness], axis=-1)
