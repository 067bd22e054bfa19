"""Where colours outside [0, 1] go (docs/display.md). numpy alone.

Fishkin, *Applying Color Science to Computer Graphics* (1983), chapter 6, has two cases. A colour too bright for the
display is scaled (6.1). One whose chromaticity lies outside the triangle of the primaries moves toward white on a
straight line, so that its dominant wavelength stays (6.2.3). The thesis multiplies what it finds there by the sum of
R, G and B, and speaks of luminance; here it is the luminance that stays.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.colorimetry.gamut.boundary import Gamut
from uplift.colorimetry.gamut.oklab import oklab, responses, roots
from uplift.common.arrays import Array, Mask

NEARLY = 2.5e-3
"""Linear RGB, relative to the largest, by which Oklab's lines may leave a gamut on the way from grey to its edge.

Seen from grey the walls of gamuts have a hollow near blue: lines leave sRGB by 0.0008, ACEScg by 0.0021, and come back.
Were that taken for the end of a line, colours on either side would end far apart.
"""
HALVINGS = 24

Way = Callable[[Array, Gamut], Array]
"""From linear RGB (n, 3), finite, all of it outside [0, 1], to what is shown instead, but for rounding."""


def clip(rgb: Array, gamut: Gamut) -> Array:
    """Each component by itself, which changes chromaticity, hue and luminance (6.1.1)."""
    return np.clip(rgb, 0, 1)


def scale(rgb: Array, gamut: Gamut) -> Array:
    """Toward white, at constant luminance, only as far as no component is negative; then divided by the largest.

    The chromaticity of what is merely too bright stays; the dominant wavelength always does.
    """
    inside = _toward_grey(rgb, np.maximum(_luminance(rgb, gamut), 0), np.inf)
    return inside / np.maximum(inside.max(axis=1, keepdims=True), 1)


def desaturate(rgb: Array, gamut: Gamut) -> Array:
    """Toward white as far as all components are within [0, 1], at constant luminance and dominant wavelength.

    What has the luminance of white, or more, becomes white; what has none, black.
    """
    return _toward_grey(rgb, np.clip(_luminance(rgb, gamut), 0, 1), 1)


def desaturate_oklab(rgb: Array, gamut: Gamut) -> Array:
    """The same at constant lightness and hue of Oklab, on whose lines reds and yellows look more of one hue."""
    lab = oklab(rgb, gamut)
    # A row a response, then a row a component: twice as fast as three numbers side by side.
    grey = np.ascontiguousarray(roots(np.clip(lab[:, :1], 0, 1) * [1, 0, 0]).T)
    chroma = np.ascontiguousarray(roots(lab * [0, 1, 1]).T)
    back = np.linalg.inv(responses(gamut))
    inner, outer = np.zeros(len(rgb)), np.ones(len(rgb))
    for _ in range(HALVINGS):
        middle = (inner + outer) / 2
        fits = _nearly_inside(back @ _cubed(grey + middle * chroma))
        inner, outer = np.where(fits, middle, inner), np.where(fits, outer, middle)
    return desaturate((back @ _cubed(grey + inner * chroma)).T, gamut)


MAPPINGS: dict[str, Way] = {
    "clip": clip,
    "scale": scale,
    "desaturate": desaturate,
    "desaturate-oklab": desaturate_oklab,
}
"""By the names of ``--out-of-gamut``."""


def _luminance(rgb: Array, gamut: Gamut) -> Array:
    """Y (n, 1)."""
    return rgb @ gamut.rgb_to_xyz[1, :, None]


def _toward_grey(rgb: Array, grey: Array, top: float) -> Array:
    """Mixtures with grey (n, 1) in [0, top], of as much colour as keeps all components in [0, top]."""
    low, high = rgb.min(axis=1, keepdims=True), rgb.max(axis=1, keepdims=True)
    below, above = np.ones_like(grey), np.ones_like(grey)
    np.divide(grey, grey - low, out=below, where=low < 0)
    np.divide(top - grey, high - grey, out=above, where=high > top)
    return grey + np.minimum(below, above) * (rgb - grey)


def _nearly_inside(rgb: Array) -> Mask:
    """Whether (n,) linear RGB (3, n) lies within [0, 1], but for `NEARLY`."""
    low, high = rgb.min(axis=0), rgb.max(axis=0)
    return np.asarray((low >= -NEARLY * high) & (high <= 1 + NEARLY))


def _cubed(values: Array) -> Array:
    """Ten times as fast as numpy's power."""
    return values * values * values
