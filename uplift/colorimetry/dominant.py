"""Dominant wavelength and excitation purity of a colour (Fishkin 1983, 3.12; CIE 15:2018, 9.3.2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

ACHROMATIC = 1e-5
"""Distance in x, y from white within which a colour has no dominant wavelength."""
SLACK = 1e-9
"""Share of an edge of the locus by which a line may miss it, so that none passes between two edges."""


@dataclass(frozen=True)
class DominantWavelength:
    """Chromaticity relative to white."""

    wavelength: float | None
    """Wavelength in nm at which the line from white through the colour meets the spectrum locus; that of the
    opposite direction for purples. None for greys and for black."""
    complementary: bool
    """Whether the colour is a purple, and the wavelength that of its complement."""
    purity: float
    """Distance of the colour from white relative to that of the spectrum locus, or of the line of purples. Above 1
    for colours that no light has."""


GREY = DominantWavelength(None, False, 0.0)


def dominant_wavelength(xyz: ArrayLike, sensor: Sensor) -> DominantWavelength:
    """Find the dominant wavelength and the purity of a colour relative to the white of a sensor.

    Shapes: ``xyz`` (3,).
    """
    colour = np.asarray(xyz, dtype=float)
    if not colour.sum() > 0:
        return GREY
    white, outline = _outline(sensor)
    direction = _chromaticity(colour) - white
    if np.hypot(*direction) < ACHROMATIC:
        return GREY
    edge, share, distance = _crossing(outline, direction)
    complementary = edge == len(outline) - 2
    if complementary:
        edge, share, _ = _crossing(outline[:-1], -direction)
    ends = sensor.wavelengths[edge : edge + 2]
    return DominantWavelength(float(ends[0] + share * (ends[1] - ends[0])), complementary, 1 / distance)


@lru_cache(maxsize=8)
def _outline(sensor: Sensor) -> tuple[Array, Array]:
    """Return x, y (2,) of white, and the spectrum locus and the line of purples around it (N + 1, 2)."""
    white = _chromaticity(sensor.light.white)
    locus = _chromaticity(sensor.cmfs) - white
    return white, np.concatenate([locus, locus[:1]])


def _chromaticity(xyz: Array) -> Array:
    """Return x, y (..., 2)."""
    return np.asarray(xyz[..., :2] / xyz.sum(axis=-1, keepdims=True))


def _crossing(path: Array, direction: Array) -> tuple[int, float, float]:
    """Return where a ray from the origin leaves a path (n, 2): the edge, the share of its length, and the distance.

    The distance is in units of ``direction`` (2,). Of several edges, as at the end of the locus, it is the farthest.
    """
    starts, edges = path[:-1], np.diff(path, axis=0)
    turn = _cross(direction, edges)
    safe = np.where(turn == 0, 1, turn)
    distance, share = _cross(starts, edges) / safe, _cross(starts, direction) / safe
    met = (turn != 0) & (distance > 0) & (share >= -SLACK) & (share <= 1 + SLACK)
    edge = int(np.where(met, distance, 0).argmax())
    return edge, float(np.clip(share[edge], 0, 1)), float(distance[edge])


def _cross(first: Array, second: Array) -> Array:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])
