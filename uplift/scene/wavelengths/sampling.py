"""A few wavelengths in place of the full spectrum, and the colour errors that they cause."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.scene.wavelengths.setup import RenderSetup

MEASURES = ("mean", "p95", "max")
"""Names of the statistics of `ColourErrors`."""


@dataclass(frozen=True, eq=False)
class Sampling:
    """Wavelengths to trace, powers of the lights there, and weights of the sum.

    A renderer traces ``powers[k] * reflectance(wavelengths)`` for light k; ``radiance @ to_xyz`` is its XYZ. One set
    of weights serves all lights, so radiances of several lights may be added first.

    Parameters
    ----------
    wavelengths : ndarray, shape (n,)
        Wavelengths in nm.
    to_xyz : ndarray, shape (n, 3)
        Weights.
    lights : tuple of str
        Names of the K lights.
    powers : ndarray, shape (K, n)
        Power of each light at each wavelength; the perfect reflector has Y near 1.
    """

    wavelengths: Array
    to_xyz: Array
    lights: tuple[str, ...]
    powers: Array

    def __len__(self) -> int:
        return len(self.wavelengths)

    def to_rgb(self, sensor: Sensor) -> Array:
        """Convert the weights to the RGB space of a sensor.

        Parameters
        ----------
        sensor : Sensor
            RGB space and illuminant; white under the illuminant is (1, 1, 1).

        Returns
        -------
        ndarray, shape (n, 3)
            Weights to linear RGB.
        """
        return self.to_xyz @ sensor.xyz_to_rgb.T

    def xyz(self, reflectances: Array) -> Array:
        """Compute the colours of materials under every light.

        Parameters
        ----------
        reflectances : ndarray, shape (M, n)
            Reflectances at the wavelengths.

        Returns
        -------
        ndarray, shape (K, M, 3)
            XYZ.
        """
        return np.asarray(reflectances @ (self.powers[:, :, None] * self.to_xyz))

    def balanced(self) -> Sampling:
        """Scale every light so that the perfect reflector has Y = 1.

        Returns
        -------
        Sampling
            The same wavelengths and weights with scaled powers.
        """
        return replace(self, powers=self.powers / (self.powers @ self.to_xyz[:, 1])[:, None])

    def ordered(self) -> Sampling:
        """Sort the wavelengths and scale the weights so that equal energy has Y = 1.

        Returns
        -------
        Sampling
            A sampling with the same radiances and colours.
        """
        order, scale = np.argsort(self.wavelengths), self.to_xyz[:, 1].sum()
        return replace(
            self,
            wavelengths=self.wavelengths[order],
            to_xyz=self.to_xyz[order] / scale,
            powers=self.powers[:, order] * scale,
        )


@dataclass(frozen=True, eq=False)
class ColourErrors:
    """Colour errors of materials under lights.

    Parameters
    ----------
    delta_e : ndarray, shape (K, M)
        ΔE00 of M materials under K lights.
    """

    delta_e: Array

    @cached_property
    def mean(self) -> float:
        """Mean over all materials and lights."""
        return float(self.delta_e.mean())

    @cached_property
    def p95(self) -> float:
        """95th percentile over all materials and lights."""
        return float(np.quantile(self.delta_e, 0.95))

    @cached_property
    def max(self) -> float:
        """Maximum over all materials and lights."""
        return float(self.delta_e.max())

    def under(self, light: int) -> ColourErrors:
        """Select the errors under one light.

        Parameters
        ----------
        light : int
            Index of the light.

        Returns
        -------
        ColourErrors
            Errors of shape (1, M).
        """
        return ColourErrors(self.delta_e[light : light + 1])


def evaluate(setup: RenderSetup, sampling: Sampling) -> ColourErrors:
    """Compare the colours of a sampling with those of the full grid.

    Parameters
    ----------
    setup : RenderSetup
        Materials and lights.
    sampling : Sampling
        Wavelengths, weights and powers for the same lights.

    Returns
    -------
    ColourErrors
        ΔE00 of every material under every light.
    """
    xyz = sampling.xyz(setup.curves(sampling.wavelengths))
    return ColourErrors(delta_e_2000(setup.lab, setup.to_lab(xyz)))
