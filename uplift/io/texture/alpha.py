"""Colours that are multiplied by alpha, as OpenEXR stores them, and colours that are not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.io.texture.source import Values

HALF_ROUNDING = 1e-3
"""Linear RGB by which half floats, converted or divided by one another, can leave [0, 1] by rounding."""


@dataclass(frozen=True)
class ColourChannels:
    """Channels of a part that hold its colours.

    Parameters
    ----------
    rgb : tuple of three int
        Indices of red, green and blue, all the same for a grey image.
    alpha : int or None
        Index of the alpha that the colours are multiplied by; None for colours that are not.
    """

    rgb: tuple[int, int, int]
    alpha: int | None = None

    def straight(self, values: Values) -> Values:
        """Return the colours (…, 3) of values (…, channels), divided by alpha if they are multiplied by it.

        Where alpha is 0, black stays black and other colours are infinite. Integers are rounded, and limited to the
        largest.
        """
        colours = values[..., self.rgb]
        if self.alpha is None:
            return colours
        alpha = values[..., [self.alpha]]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            divided = np.where(colours == 0, 0, colours / alpha)
        if np.issubdtype(values.dtype, np.integer):
            top = np.iinfo(values.dtype).max
            return np.rint(np.minimum(divided, 1) * top).astype(values.dtype)
        return without_rounding(divided)

    def opacity(self, values: Values) -> NDArray[np.float32] | None:
        """Return what to multiply converted colours by, (…, 1) in [0, 1]; None if they were not divided.

        Where alpha is NaN, the opacity is 0.
        """
        if self.alpha is None:
            return None
        alpha = values[..., [self.alpha]]
        scale = np.iinfo(alpha.dtype).max if np.issubdtype(alpha.dtype, np.integer) else 1
        return np.clip(np.nan_to_num(alpha / scale, nan=0.0), 0, 1).astype(np.float32)


def without_rounding(rgb: Values) -> Values:
    """Clip colours that lie outside [0, 1] by no more than the rounding of half floats."""
    inside = np.clip(rgb, 0, 1)
    is_rounding = np.abs(rgb - inside).max(axis=-1, keepdims=True) <= HALF_ROUNDING
    return np.where(is_rounding, inside, rgb)
