"""What screens show: the sRGB curve, from linear values to what a PNG holds and back (IEC 61966-2-1), and its gamut.

Screens and viewers take a PNG for sRGB whatever the cube's space, so this is not the cube's own encoding.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut import SRGB, Gamut, conversion, map_to_gamut
from uplift.common.arrays import Array

SHOWN = "desaturate"
"""What becomes of colours that no screen shows: swatches keep luminance and dominant wavelength."""


def decode(codes: Array) -> Array:
    """Linear values of encoded ones, both in [0, 1]."""
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def encode(linear: ArrayLike) -> Array:
    """Encoded values of linear ones; both in [0, 1], what is outside is clipped."""
    inside = np.clip(np.asarray(linear, dtype=float), 0, 1)
    return np.where(inside <= 0.0031308, inside * 12.92, 1.055 * inside ** (1 / 2.4) - 0.055)


def to_display_codes(rgb: ArrayLike, gamut: Gamut) -> Array:
    """8-bit codes (…, 3), as whole numbers, of linear RGB (…, 3) of a gamut, on a screen that white is white on."""
    linear = map_to_gamut(np.asarray(rgb, dtype=float) @ conversion(gamut, SRGB).T, SRGB, SHOWN).rgb
    return np.rint(255 * encode(linear))
