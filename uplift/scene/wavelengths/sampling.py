"""A few wavelengths in place of the whole spectrum: what a renderer needs to know, and what it costs in colour."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.scene.wavelengths.setup import RenderSetup

MEASURES = ("mean", "p95", "max")
"""What may be said of errors, as `ColourErrors` names it."""


@dataclass(frozen=True, eq=False)
class Sampling:
    """Wavelengths to trace, powers of the lights there, weights to sum with.

    A renderer traces ``powers[k] · reflectance(wavelengths)`` for light k, and ``radiance @ to_xyz`` is XYZ; one
    set of weights serves all lights, so radiances of several lights may be added before.

    Parameters
    ----------
    wavelengths : (n,) nm, ascending.
    to_xyz : (n, 3) weights.
    lights : names of the lights.
    powers : (K, n) what each light sends at each wavelength; the perfect reflector has Y near 1.
    """

    wavelengths: Array
    to_xyz: Array
    lights: tuple[str, ...]
    powers: Array

    def __len__(self) -> int:
        return len(self.wavelengths)

    def to_rgb(self, sensor: Sensor) -> Array:
        """(n, 3) weights to linear RGB: white under the sensor's illuminant is (1, 1, 1)."""
        return self.to_xyz @ sensor.xyz_to_rgb.T

    def xyz(self, reflectances: Array) -> Array:
        """XYZ (K, M, 3) of reflectances (M, n) at the wavelengths, under every light."""
        return np.asarray(reflectances @ (self.powers[:, :, None] * self.to_xyz))

    def balanced(self) -> Sampling:
        """The same, every light scaled so that the perfect reflector has Y = 1."""
        return replace(self, powers=self.powers / (self.powers @ self.to_xyz[:, 1])[:, None])

    def ordered(self) -> Sampling:
        """The same with wavelengths ascending and weights scaled so that equal energy has Y = 1."""
        order, scale = np.argsort(self.wavelengths), self.to_xyz[:, 1].sum()
        return replace(
            self,
            wavelengths=self.wavelengths[order],
            to_xyz=self.to_xyz[order] / scale,
            powers=self.powers[:, order] * scale,
        )


@dataclass(frozen=True, eq=False)
class ColourErrors:
    """ΔE00 (K, M) of materials under lights."""

    delta_e: Array

    @cached_property
    def mean(self) -> float:
        return float(self.delta_e.mean())

    @cached_property
    def p95(self) -> float:
        """What 95 % of all materials under all lights stay under."""
        return float(np.quantile(self.delta_e, 0.95))

    @cached_property
    def max(self) -> float:
        return float(self.delta_e.max())

    def under(self, light: int) -> ColourErrors:
        """The errors under one light."""
        return ColourErrors(self.delta_e[light : light + 1])


def evaluate(setting: RenderSetup, sampling: Sampling) -> ColourErrors:
    """What the sampling makes of every material under every light, against the sum over the whole grid."""
    seen = sampling.xyz(setting.curves(sampling.wavelengths))
    return ColourErrors(delta_e_2000(setting.lab, setting.to_lab(seen)))
