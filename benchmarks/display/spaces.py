"""Perceptual spaces of colour-science in which colours could be desaturated: preservation of hue, smoothness."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import colour
import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.common.arrays import Array

HALVINGS = 30
NEARLY = 1e-4
XYZ = Callable[[Array], Any]
WHITE = np.array(SRGB.white)
ACESCG = Primaries((0.713, 0.293), (0.165, 0.83), (0.128, 0.044), SRGB.white)
"""With the white of sRGB, for which the spaces of colour-science are defined."""


@dataclass(frozen=True)
class Space:
    """Conversion from XYZ under D65 to lightness and two opponent coordinates, and back."""

    name: str
    of: XYZ
    back: XYZ


SPACES = (
    Space("Oklab", colour.XYZ_to_Oklab, colour.Oklab_to_XYZ),
    Space("CIELAB", lambda xyz: colour.XYZ_to_Lab(xyz, WHITE), lambda lab: colour.Lab_to_XYZ(lab, WHITE)),
    Space("CIELUV", lambda xyz: colour.XYZ_to_Luv(xyz, WHITE), lambda luv: colour.Luv_to_XYZ(luv, WHITE)),
    Space("IPT", colour.XYZ_to_IPT, colour.IPT_to_XYZ),
    Space("ICtCp", lambda xyz: colour.XYZ_to_ICtCp(100 * xyz), lambda ictcp: colour.ICtCp_to_XYZ(ictcp) / 100),
    Space("CAM16-UCS", colour.XYZ_to_CAM16UCS, colour.CAM16UCS_to_XYZ),
)


def desaturate(space: Space, rgb: Array) -> Array:
    """Reduce the chroma of linear sRGB (n, 3) at constant lightness and hue of a space until it is in gamut."""
    found = np.asarray(space.of(rgb @ SRGB.rgb_to_xyz.T))
    white = np.asarray(space.of(SRGB.rgb_to_xyz.sum(axis=1)))[0]
    found[:, 0] = np.clip(found[:, 0], 0, white)
    inner, outer = np.zeros((len(rgb), 1)), np.ones((len(rgb), 1))
    for _ in range(HALVINGS):
        middle = (inner + outer) / 2
        over = _over(_at(space, found, middle, SRGB))[:, None]
        inner, outer = np.where(over <= NEARLY, middle, inner), np.where(over <= NEARLY, outer, middle)
    return np.clip(_at(space, found, inner, SRGB), 0, 1)


def concavity(space: Space, gamut: Primaries, count: int = 24) -> float:
    """Return how far lines from grey to the surface of [0, 1]³ leave the cube at most, in linear RGB."""
    u, v = (part.ravel() for part in np.meshgrid(*[np.linspace(0, 1, count)] * 2))
    sides = [np.insert(np.stack([u, v], 1), axis, end, axis=1) for axis in range(3) for end in (0.0, 1.0)]
    found = np.asarray(space.of(np.concatenate(sides) @ gamut.rgb_to_xyz.T))
    return max(float(_over(_at(space, found, share, gamut)).max()) for share in np.linspace(0.02, 0.98, 49))


def _at(space: Space, found: Array, share: Array | float, gamut: Primaries) -> Array:
    """Return linear RGB with a share of the chroma."""
    less = np.concatenate([found[:, :1], share * found[:, 1:]], axis=1)
    return np.asarray(space.back(less)) @ np.linalg.inv(gamut.rgb_to_xyz).T


def _over(rgb: Array) -> Array:
    return np.maximum(-rgb, rgb - 1).max(axis=1)
