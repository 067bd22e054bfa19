"""A sensor turns reflectances into linear RGB: plain arrays, stored in every cube (docs/mathematics.md, 1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array

SLACK = 1e-9
"""How far outside [0, 1] a colour may lie by rounding alone."""


@dataclass(frozen=True, eq=False)
class Light:
    """An illuminant seen by an observer: a reflectance's XYZ under it (white has Y = 1).

    Parameters
    ----------
    name : the illuminant's name.
    xyz : (3, N) weights; ``xyz @ reflectance`` is XYZ.
    """

    name: str
    xyz: Array

    @cached_property
    def white(self) -> Array:
        """(3,) XYZ of the perfect reflector."""
        return self.xyz.sum(axis=1)


@dataclass(frozen=True, eq=False)
class Sensor:
    """Observer, illuminant and RGB space folded into one 3×N matrix.

    Parameters
    ----------
    space, illuminant, observer : names, as colour-science spells them.
    wavelengths : (N,) nm, evenly spaced, ascending.
    cmfs : (N, 3) colour-matching functions.
    power : (N,) relative spectral power of the illuminant.
    xyz_to_rgb : (3, 3) XYZ under the illuminant (white has Y = 1) to linear RGB; white gives (1, 1, 1).
    decoding : (256,) linear value of every 8-bit code of the space.
    """

    space: str
    illuminant: str
    observer: str
    wavelengths: Array
    cmfs: Array
    power: Array
    xyz_to_rgb: Array
    decoding: Array

    @cached_property
    def light(self) -> Light:
        """The build illuminant."""
        weights = self.cmfs * self.power[:, None]
        return Light(self.illuminant, (weights / weights[:, 1].sum()).T)

    @cached_property
    def matrix(self) -> Array:
        """(3, N) W: ``W @ reflectance`` is linear RGB; the perfect reflector gives (1, 1, 1)."""
        return self.xyz_to_rgb @ self.light.xyz

    def rgb(self, reflectance: ArrayLike) -> Array:
        """Linear RGB (…, 3) of reflectances (…, N) sampled at ``wavelengths``."""
        return np.asarray(reflectance, dtype=float) @ self.matrix.T

    def decode(self, codes: ArrayLike) -> Array:
        """Linear values (…) of 8-bit codes (…), 0 to 255; fractions are interpolated."""
        return np.interp(np.asarray(codes, dtype=float), np.arange(256), self.decoding)

    def holds(self, rgb: ArrayLike) -> NDArray[np.bool_]:
        """Whether linear RGB (…, 3) lies within the space; rounding takes nothing out of it."""
        array = np.asarray(rgb, dtype=float)
        return np.asarray(((array >= -SLACK) & (array <= 1 + SLACK)).all(axis=-1))

    @cached_property
    def rgb_to_xyz(self) -> Array:
        """(3, 3) linear RGB to XYZ under the build illuminant."""
        return np.asarray(np.linalg.inv(self.xyz_to_rgb))

    def xyz(self, rgb: ArrayLike) -> Array:
        """XYZ (…, 3) under the build illuminant of linear RGB (…, 3)."""
        return np.asarray(rgb, dtype=float) @ self.rgb_to_xyz.T
