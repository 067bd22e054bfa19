"""Dominant wavelength and excitation purity of a colour (Fishkin 1983, 3.12; CIE
15:2018, 9.3.2).
"""

from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask

ACHROMATIC = 1e-5
"""Distance in x, y from white within which a colour has no dominant wavelength."""
SLACK = 1e-9
"""Fraction of an edge of the locus by which a line may miss it, so that none passes
between two edges.
"""


def dominant_wavelengths(xyz: Array, sensor: Sensor) -> tuple[Array, Mask, Array]:
    """Find the dominant wavelengths of colours (n, 3), relative to the white of a
    sensor, whether they are those of the complement, and the purities.

    The line from white through a colour meets the spectrum locus at the dominant
    wavelength in nm, for purples in the opposite direction. It is NaN for greys and
    black. Purity is the distance of the colour from white relative to that of the
    locus, or of the line of purples: above 1 for colours that no light has.
    """
    responds = sensor.cmfs.any(axis=1)
    wavelengths = sensor.wavelengths[responds]
    locus = sensor.cmfs[responds]
    # x, y of white, and from there to the spectrum locus and the line of purples around
    # it (n + 1, 2)
    curves = np.concatenate([sensor.light.white[None], locus, locus[:1]])
    xy = curves[:, :2] / curves.sum(axis=1, keepdims=True)
    white = xy[0]
    outline = xy[1:] - xy[0]
    total = xyz.sum(axis=1, keepdims=True)
    is_lit = total > 0
    directions = xyz[:, :2] / np.where(is_lit, total, 1) - white
    rows = np.flatnonzero(is_lit[:, 0] & ~(np.hypot(*directions.T) < ACHROMATIC))
    directions = directions[rows]
    # The ray white + distance · direction leaves the outline at the locus, or at the
    # line of purples, the last edge.
    edge, fraction, distance = crossing(outline, directions)
    is_purple = edge == len(outline) - 2
    opposite = crossing(outline[:-1], -directions[is_purple])
    edge[is_purple], fraction[is_purple], _ = opposite
    first = wavelengths[edge]
    second = wavelengths[edge + 1]
    wavelength = np.full(len(xyz), np.nan)
    complementary = np.zeros(len(xyz), dtype=bool)
    purity = np.zeros(len(xyz))
    wavelength[rows] = first + fraction * (second - first)
    complementary[rows] = is_purple
    purity[rows] = 1 / distance
    return wavelength, complementary, purity


def crossing(path: Array, direction: Array) -> tuple[Any, Array, Array]:
    """Return where rays from the origin leave a path: the edge, the fraction of its
    length, and the distance.

    The distance is in units of the direction, infinite for a ray that meets no edge. Of
    several edges, as at the end of the locus, it is the farthest. Shapes: ``path`` (n,
    2), or one of each ray (..., n, 2), ``direction`` (..., 2) → (...).
    """
    # t · direction = start + f · edge, solved by Cramer's rule
    x, y = np.moveaxis(path[..., :-1, :], -1, 0)
    u, v = np.moveaxis(np.diff(path, axis=-2), -1, 0)
    a = direction[..., :1]
    b = direction[..., 1:]
    determinant = a * v - b * u
    safe = np.where(determinant == 0, 1, determinant)
    distance = (x * v - y * u) / safe
    fraction = (x * b - y * a) / safe
    met = (
        (determinant != 0)
        & (distance > 0)
        & (fraction >= -SLACK)
        & (fraction <= 1 + SLACK)
    )
    edge = np.where(met, distance, 0).argmax(axis=-1, keepdims=True)
    place, reach = (
        np.take_along_axis(each, edge, -1)[..., 0]
        for each in (fraction, np.where(met, distance, np.inf))
    )
    return edge[..., 0], np.clip(place, 0, 1), reach
