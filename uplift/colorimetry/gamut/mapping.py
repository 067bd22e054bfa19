"""Gamut mapping methods for linear RGB outside [0, 1] (docs/display.md).

Fishkin 1983, *Applying Color Science to Computer Graphics*, chapter 6, distinguishes two cases. A colour too bright
for the display is scaled (6.1). A chromaticity outside the triangle of the primaries moves toward white on a straight
line, which keeps the dominant wavelength (6.2.3). There the thesis multiplies the result by the sum of R, G and B, and
calls this luminance. Here the luminance itself is kept.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.colorimetry.gamut.boundary import Gamut
from uplift.colorimetry.gamut.oklab import cone_responses, cube_roots, oklab
from uplift.common.arrays import Array, Mask

NEARLY = 2.5e-3
"""Linear RGB, relative to the largest component, by which a line in Oklab may leave the gamut before its edge.

The boundary of a gamut is concave near blue: lines from grey leave sRGB by 0.0008, ACEScg by 0.0021, and return.
Stopping at the first exit would map neighbouring colours far apart.
"""
HALVINGS = 24
"""Bisection steps along a line."""

LARGEST = 1e300
"""Colours are scaled down to components of this magnitude where sums of three could overflow."""

Mapping = Callable[[Array, Gamut], Array]
"""Function from finite linear RGB (n, 3) outside [0, 1] to linear RGB (n, 3) inside, up to rounding."""


def clip(rgb: Array, gamut: Gamut) -> Array:
    """Clip each component separately, which changes chromaticity, hue and luminance (Fishkin, 6.1.1)."""
    return np.clip(rgb, 0, 1)


def scale(rgb: Array, gamut: Gamut) -> Array:
    """Move toward white at constant luminance until no component is negative, then divide by the largest.

    The dominant wavelength is kept. So is the chromaticity of colours that are only too bright.
    """
    rgb = _without_overflow(rgb)
    inside = _toward_grey(rgb, np.maximum(_luminance(rgb, gamut), 0), np.inf)
    return inside / np.maximum(inside.max(axis=1, keepdims=True), 1)


def desaturate(rgb: Array, gamut: Gamut) -> Array:
    """Move toward white at constant luminance and dominant wavelength until all components are in [0, 1].

    A luminance of at least that of white gives white. A luminance of at most 0 gives black.
    """
    rgb = _without_overflow(rgb)
    return _toward_grey(rgb, np.clip(_luminance(rgb, gamut), 0, 1), 1)


def desaturate_oklab(rgb: Array, gamut: Gamut) -> Array:
    """Move toward grey at constant lightness and hue of Oklab, which keeps the hue of reds and yellows better."""
    rgb = _without_overflow(rgb)
    lab = oklab(rgb, gamut)
    # One row per response, then one per component: contiguous rows are twice as fast here.
    grey = np.ascontiguousarray(cube_roots(np.clip(lab[:, :1], 0, 1) * [1, 0, 0]).T)
    chroma = np.ascontiguousarray(cube_roots(lab * [0, 1, 1]).T)
    to_rgb = np.linalg.inv(cone_responses(gamut))
    inner, outer = np.zeros(len(rgb)), np.ones(len(rgb))
    for _ in range(HALVINGS):
        middle = (inner + outer) / 2
        fits = _nearly_inside(to_rgb @ _cube(grey + middle * chroma))
        inner, outer = np.where(fits, middle, inner), np.where(fits, outer, middle)
    return desaturate((to_rgb @ _cube(grey + inner * chroma)).T, gamut)


MAPPINGS: dict[str, Mapping] = {
    "clip": clip,
    "scale": scale,
    "desaturate": desaturate,
    "desaturate-oklab": desaturate_oklab,
}
"""Mappings by the name of their method."""


def _without_overflow(rgb: Array) -> Array:
    return rgb * np.minimum(1, LARGEST / np.maximum(np.abs(rgb).max(axis=1, keepdims=True), 1))


def _luminance(rgb: Array, gamut: Gamut) -> Array:
    """Y (n, 1)."""
    return rgb @ gamut.rgb_to_xyz[1, :, None]


def _toward_grey(rgb: Array, grey: Array, top: float) -> Array:
    """Mix with grey (n, 1) in [0, top], keeping as much colour as all components in [0, top] allow."""
    low, high = rgb.min(axis=1, keepdims=True), rgb.max(axis=1, keepdims=True)
    below, above = np.ones_like(grey), np.ones_like(grey)
    np.divide(grey, grey - low, out=below, where=low < 0)
    np.divide(top - grey, high - grey, out=above, where=high > top)
    return grey + np.minimum(below, above) * (rgb - grey)


def _nearly_inside(rgb: Array) -> Mask:
    """Whether (n,) linear RGB (3, n) lies within [0, 1], up to `NEARLY`."""
    low, high = rgb.min(axis=0), rgb.max(axis=0)
    return np.asarray((low >= -NEARLY * high) & (high <= 1 + NEARLY))


def _cube(values: Array) -> Array:
    """Third power, ten times as fast as numpy's ``**``."""
    return values * values * values
