"""Bounds of answers: how far any reflectance of a colour can be from the answer under another light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.largest_difference import LargestDifference, largest_difference
from uplift.colorimetry.mismatch import DIVISIONS, MismatchVolumes, mismatch_volumes
from uplift.colorimetry.outline import outline
from uplift.colorimetry.sensor import Light, in_unit_cube
from uplift.colorimetry.solid import solid_volume
from uplift.common.arrays import Array
from uplift.lookup.cube import Cube
from uplift.lookup.light_errors import lab_errors
from uplift.lookup.outside import reflectance_outside


@dataclass(frozen=True, eq=False, repr=False)
class Bounds:
    """Bounds of the answers to n colours under a light.

    Parameters
    ----------
    light : Light
        The light.
    reflectance : ndarray, shape (n, N)
        The answers at the wavelengths of the sensor.
    xyz : ndarray, shape (n, 3)
        XYZ of the answers under the light.
    volumes : MismatchVolumes
        XYZ of all reflectances of the colours.
    largest : LargestDifference
        The reflectances whose colour differs most from that of the answer.
    covariance : ndarray, shape (n, 3, 3), optional
        Expected covariance of L*a*b* of a material of the colour, around the answer; None if the cube has no
        left-out entries.
    likely_radius : float, optional
        Mahalanobis distance in a* and b* that `LIKELY` of the materials like the atlas stay within.
    """

    light: Light
    reflectance: Array
    xyz: Array
    volumes: MismatchVolumes
    largest: LargestDifference
    covariance: Array | None
    likely_radius: float | None

    @property
    def lab(self) -> Array:
        """L*a*b* of the answers, shape (n, 3)."""
        return lab(self.xyz, self.light.white)

    @property
    def share(self) -> Array:
        """Volumes of the metamers as shares (n,) of all colours of reflectances under the light."""
        return self.volumes.volume / solid_volume(self.light.xyz)

    @property
    def box(self) -> Array:
        """Least and largest L*, a* and b* of the boundary points, shape (n, 2, 3)."""
        found = self.volumes.lab
        return np.stack([found.min(axis=1), found.max(axis=1)], axis=1)

    def outline(self, row: int) -> Array:
        """Compute the outline in a* and b* of all colours that the reflectances of a colour can have.

        Parameters
        ----------
        row : int
            The colour.

        Returns
        -------
        ndarray, shape (M, 2)
        """
        return outline(self.volumes.lab[row, :, 1:], self.volumes.directions.faces)

    def likely(self, row: int) -> Array | None:
        """Compute the ellipse in a* and b* that holds `LIKELY` of the materials like the atlas.

        Parameters
        ----------
        row : int
            The colour.

        Returns
        -------
        ndarray, shape (M, 2), optional
            None without a covariance.
        """
        if self.covariance is None or self.likely_radius is None:
            return None
        values, axes = np.linalg.eigh(self.covariance[row, 1:, 1:])
        turn = np.linspace(0, 2 * np.pi, 73)[:-1]
        circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return np.asarray(self.lab[row, 1:] + self.likely_radius * (circle * np.sqrt(np.maximum(values, 0))) @ axes.T)


def bounds(cube: Cube, rgb: Array, light: Light, mode: str = "spectra", divisions: int = DIVISIONS) -> Bounds:
    """Compute bounds of answers under a light.

    Parameters
    ----------
    cube : Cube
        The cube.
    rgb : ndarray, shape (n, 3)
        Linear RGB; those outside [0, 1] are answered by `reflectance_outside`.
    light : Light
        A light at the wavelengths of the sensor.
    mode : str, default "spectra"
        One of `MODES`, for colours in [0, 1].
    divisions : int, default 2
        Density of the boundary points, see `mismatch_volumes`.

    Returns
    -------
    Bounds

    Raises
    ------
    ColourError
        No reflectance has a colour (code ``colour-unrealisable``).
    OptionError
        An unknown mode.
    """
    data = cube.data
    volumes = mismatch_volumes(data.sensor, light, rgb, divisions)
    inside = in_unit_cube(rgb)
    spectra = np.empty((len(rgb), len(data.sensor.wavelengths)))
    spectra[inside] = cube.reflectance(rgb[inside], mode=mode)
    if not inside.all():
        spectra[~inside] = reflectance_outside(data, rgb[~inside], data.sensor.wavelengths)
    xyz = spectra @ light.xyz.T
    errors = None if data.atlas.left_out is None else lab_errors(data, light)
    covariance = None if errors is None else errors.covariance(np.clip(rgb, 0, 1))
    radius = None if errors is None else errors.likely_radius
    return Bounds(light, spectra, xyz, volumes, largest_difference(volumes, xyz), covariance, radius)
