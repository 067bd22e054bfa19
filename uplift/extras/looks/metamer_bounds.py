"""Bounds of answers: how far the colour of any reflectance of an RGB can be from the
answer's under another light.
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry import Light, in_unit_cube, lab, solid_volume
from uplift.common.arrays import Array
from uplift.extras.looks import mesh, mismatch
from uplift.extras.looks.lab_errors import LabErrors, lab_errors
from uplift.lookup import Cube
from uplift.lookup.outside import reflectance_anywhere


@dataclass(frozen=True, eq=False, repr=False)
class Bounds:
    """Bounds of the answers to n colours under a light."""

    light: Light
    reflectance: Array
    """(n, N) the answers at the wavelengths of the sensor."""
    xyz: Array
    """(n, 3) their XYZ under the light."""
    volumes: mismatch.MismatchVolumes
    """XYZ of all reflectances of the colours."""
    largest: mismatch.LargestDifference
    """The reflectances whose colour differs most from that of the answer."""
    covariance: Array | None
    """(n, 3, 3) expected covariance of L*a*b* of a material of the colour; None without
    left-out entries.
    """
    likely_radius: float | None
    """Mahalanobis distance in a* and b* that `LIKELY` of the materials like the atlas
    stay within.
    """

    @property
    def lab(self) -> Array:
        """L*a*b* of the answers, shape (n, 3)."""
        return lab(self.xyz, self.light.white)

    @property
    def share(self) -> Array:
        """Volumes of the metamers as shares (n,) of all colours of reflectances under
        the light.
        """
        return self.volumes.volume / solid_volume(self.light.xyz)

    @property
    def box(self) -> Array:
        """Least and largest L*, a* and b* of the boundary points, shape (n, 2, 3)."""
        lab = self.volumes.lab
        return np.stack([lab.min(axis=1), lab.max(axis=1)], axis=1)

    def outline(self, row: int) -> Array:
        """Compute the outline (M, 2) in a* and b* of all colours that the reflectances
        of colour ``row`` can have.
        """
        return mesh.outline(self.volumes.lab[row, :, 1:], self.volumes.directions.faces)

    def likely(self, row: int) -> Array | None:
        """Compute the ellipse (M, 2) in a* and b* that holds `LIKELY` of the materials
        like the atlas, if known.
        """
        if self.covariance is None or self.likely_radius is None:
            return None
        values, axes = np.linalg.eigh(self.covariance[row, 1:, 1:])
        # With Σ = V Λ Vᵀ, the ellipse is μ + radius · V √Λ (cos, sin).
        turn = np.linspace(0, 2 * np.pi, 73)[:-1]
        circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return (
            self.lab[row, 1:]
            + self.likely_radius * (circle * np.sqrt(np.maximum(values, 0))) @ axes.T
        )


def bounds(
    cube: Cube,
    rgb: Array,
    light: Light,
    mode: str = "spectra",
    divisions: int = mismatch.DIVISIONS,
) -> Bounds:
    """Compute bounds of the answers to linear RGB (n, 3) under a light at the
    wavelengths of the sensor.

    Colours outside [0, 1] are answered by `reflectance_anywhere`; ``divisions`` (0 to
    4) sets the number of boundary points, see `uplift.extras.looks.mismatch.COUNTS`.
    Raises `ColourError` if no reflectance has a colour.
    """
    data = cube.data
    volumes = mismatch.mismatch_volumes(data.sensor, light, rgb, divisions)
    spectra = reflectance_anywhere(
        data, rgb, data.sensor.wavelengths, mode, ~in_unit_cube(rgb)
    )
    errors = None if data.atlas.left_out is None else lab_errors(data, light)
    return bounds_around(light, spectra, volumes, rgb, errors)


def bounds_around(
    light: Light,
    spectra: Array,
    volumes: mismatch.MismatchVolumes,
    rgb: Array,
    errors: LabErrors | None,
) -> Bounds:
    """Return the bounds around answers (n, N) to linear RGB (n, 3)."""
    xyz = spectra @ light.xyz.T
    largest = mismatch.largest_difference(volumes, xyz)
    covariance = None if errors is None else errors.covariance(rgb)
    radius = None if errors is None else errors.likely_radius
    return Bounds(light, spectra, xyz, volumes, largest, covariance, radius)
