"""Passes of an RGB renderer: bands, numbers of lights, and matrices to XYZ.

The idea is old: Meyer 1988, "Wavelength selection for synthetic image generation";
Peercy 1993, "Linear color representations for full speed spectral rendering"; Ward &
Eydelberg-Vileshin 2002, "Picture perfect RGB rendering using spectral prefiltering and
sharp color primaries"; Bergner et al. 2004. Here bands are chosen so that products of
one to four reflectances keep their colours.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.common.arrays import Array
from uplift.common.errors import unknown_name
from uplift.extras.files.spec import SPEC, Matrix, NotNegative, NotNegativeRow
from uplift.extras.scene.passes.bands import Bands

STEPS = 1_000_000
"""Steps of power up to the largest, by which digests do not depend on rounding."""


@dataclass(frozen=True, eq=False)
class PassesLight:
    """A light of passes.

    Parameters
    ----------
    name : str
        Name of the illuminant, or of the lamp.
    digest : str
        SHA-256 of its power, in steps of 1e-6 of the largest.
    numbers : ndarray, shape (K,)
        Numbers of the light, at least 0, scaled so that the perfect reflector has
        Y = 1. The light of equal energy has ones.
    to_xyz : ndarray, shape (3, K)
        Matrix for scenes that this light alone lights.
    errors, own_errors : ndarray, shape (4,)
        Mean ΔE00 of one to four bounces over held-out materials, by the matrix of all
        lights and by that of this light.
    """

    __pydantic_config__ = SPEC

    name: str
    digest: str
    numbers: NotNegativeRow
    to_xyz: Matrix
    errors: NotNegativeRow
    own_errors: NotNegativeRow


@dataclass(frozen=True, eq=False)
class PassesCamera:
    """A camera whose raw values pictures of passes are decoded to.

    Parameters
    ----------
    name : str
        Name of the camera.
    matrix : ndarray, shape (3, K)
        Matrix from the numbers of pixels to raw values, where the perfect reflector
        under D65, of Y = 1, has 1. It serves all lights and mixtures of them.
    error : float
        Mean relative error of raw values of one to four bounces over held-out
        materials.
    """

    __pydantic_config__ = SPEC

    name: str
    matrix: Matrix
    error: NotNegative


@dataclass(frozen=True, eq=False)
class Passes:
    """How an RGB renderer renders spectra: three bands a pass.

    Parameters
    ----------
    bands : Bands
        The K bands. Pass p has bands 3 p, 3 p + 1 and 3 p + 2 as red, green and blue.
    to_xyz : ndarray, shape (3, K)
        Matrix from the numbers of pixels to XYZ, for all lights and mixtures of them.
    lights : tuple of PassesLight
        The lights that the matrices are fitted to.
    light_projection : ndarray, shape (K, 81)
        Matrix from the power of any light at 380, 385, …, 780 nm to its numbers.
    origin : mapping
        What the materials are, as `Materials.origin`, and how many.
    camera : PassesCamera, optional
        A camera, by `with_camera`.
    """

    bands: Bands
    to_xyz: Array
    lights: tuple[PassesLight, ...]
    light_projection: Array
    origin: Mapping[str, Any]
    camera: PassesCamera | None = None

    @property
    def count(self) -> int:
        """Number of passes."""
        return self.bands.passes

    @property
    def error(self) -> float:
        """Mean ΔE00 over the lights and one to four bounces, by the shared matrix."""
        return float(np.mean([light.errors for light in self.lights]))

    def reflectance_numbers(self, reflectances: Array) -> Array:
        """Compute the numbers of surfaces.

        Parameters
        ----------
        reflectances : ndarray, shape (…, 81)
            Reflectances at 380, 385, …, 780 nm.

        Returns
        -------
        ndarray, shape (…, K)
            Numbers in [0, 1].
        """
        return np.clip(reflectances @ self.bands.weights.T, 0, 1)

    def light_numbers(self, power: Array) -> Array:
        """Compute the numbers of lights that the passes were not fitted to.

        Parameters
        ----------
        power : ndarray, shape (…, 81)
            Power at 380, 385, …, 780 nm, where `scaled_power` has Y = 1.

        Returns
        -------
        ndarray, shape (…, K)
            Numbers. Those of lights of nearly one wavelength may be negative.
        """
        return power @ self.light_projection.T

    def light(self, name: Illuminant) -> PassesLight:
        """Find a light by its name, or a lamp by its spectrum.

        Parameters
        ----------
        name : str or Lamp
            Name in the passes, or a lamp.

        Returns
        -------
        PassesLight

        Raises
        ------
        UnknownNameError
            The passes have no light of this name or spectrum.
        """
        named = {light.name: light for light in self.lights}
        known = named
        key = str(name)
        if isinstance(name, Lamp):
            known = {light.digest: light for light in self.lights}
            key = power_digest(scaled_power(name))
        if key not in known:
            raise unknown_name(str(name), named, "light of the passes")
        return known[key]


def scaled_power(illuminant: Illuminant) -> Array:
    """Compute the power of an illuminant with which the perfect reflector has Y = 1.

    Parameters
    ----------
    illuminant : str or Lamp
        Illuminant.

    Returns
    -------
    ndarray, shape (81,)
        Power at 380, 385, …, 780 nm.

    Raises
    ------
    UnknownNameError
        The illuminant is unknown.
    """
    power = observer.illuminant_spd(illuminant)
    luminance = observer.matching_functions()[:, 1]
    return power / (power @ luminance)


def power_digest(power: Array) -> str:
    """SHA-256 of a power (81,) relative to its largest value.

    >>> power_digest(np.array([1.0, 2.0])) == power_digest(np.array([2.0, 4.0]))
    True
    """
    relative = np.rint(STEPS * power / power.max()).astype("<u4")
    return hashlib.sha256(relative.tobytes()).hexdigest()
