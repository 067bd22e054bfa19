"""Cameras: measured spectral sensitivities, in place of the colour-matching functions
of an observer.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, as_nm
from uplift.common.errors import OptionError

CAMERA = "camera"
"""Name of the RGB space of raw values, balanced so that the perfect reflector is (1, 1,
1).
"""
LAYOUT = "give rows of a wavelength in nm and the sensitivities of red, green and blue"
CAMERA_FILES = (".csv", ".tsv", ".txt", ".json")
"""Suffixes of files of sensitivities, which distinguish them from names."""
CORRELATED = 50.0
"""Distance in nm over which the correlation of the reflectances that a camera's matrix
is fitted to falls to 1/e.
"""
MAX_CONDITION = 1e4
"""Limit of the condition number of a camera's matrix: one channel is a mixture of the
others beyond it.
"""


@dataclass(frozen=True, eq=False)
class Camera:
    """Spectral sensitivities of a camera with three channels, validated on creation.

    >>> sensitivities = [[0, 0, 2], [0, 4, 0], [3, 0, 0]]
    >>> Camera("narrow", [400, 550, 700], sensitivities).sensitivities.tolist()
    [[0.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.75, 0.0, 0.0]]
    """

    name: str
    """Name."""
    wavelengths: Array
    """(N,) Wavelengths in nm, ascending."""
    sensitivities: Array
    """(N, 3) Sensitivities of red, green and blue, not negative, in any one unit. They
    are divided by the largest.
    """

    def __post_init__(self) -> None:
        wavelengths = np.array(self.wavelengths, dtype=float)
        sensitivities = np.array(self.sensitivities, dtype=float)
        problem = ""
        if (
            wavelengths.ndim != 1
            or len(wavelengths) < 2
            or sensitivities.shape != (len(wavelengths), 3)
        ):
            shapes = f"{wavelengths.shape} and {sensitivities.shape}"
            problem = (
                "sensitivities need at least 2 wavelengths (N,) and values (N, 3), "
                f"got {shapes}"
            )
        elif not (np.isfinite(wavelengths).all() and np.isfinite(sensitivities).all()):
            problem = "wavelengths and sensitivities must be finite"
        elif (np.diff(wavelengths) <= 0).any():
            first = int((np.diff(wavelengths) <= 0).argmax())
            problem = (
                f"wavelengths must ascend, got {wavelengths[first]:g} nm, then "
                f"{wavelengths[first + 1]:g} nm"
            )
        elif (sensitivities < 0).any():
            problem = f"sensitivities must not be negative, got {sensitivities.min():g}"
        if problem:
            raise OptionError(problem, hint=LAYOUT)
        object.__setattr__(self, "wavelengths", wavelengths)
        object.__setattr__(
            self, "sensitivities", sensitivities / (sensitivities.max() or 1.0)
        )

    def at(self, wavelengths: ArrayLike) -> Array:
        """Interpolate the sensitivities (M, 3) linearly at wavelengths (M,) in nm;
        outside their range they are 0.
        """
        at = as_nm(wavelengths)
        channels = (
            np.interp(at, self.wavelengths, channel, left=0, right=0)
            for channel in self.sensitivities.T
        )
        return np.stack(list(channels), axis=1)


def camera_sensor(camera: Camera, standard: Sensor) -> Sensor:
    """Make the sensor of a camera's raw values, balanced so that the perfect reflector
    is (1, 1, 1).

    Illuminant, observer and wavelengths are those of a standard sensor. The matrix from
    XYZ, for distances between colours only, is the least-squares fit for smooth
    reflectances, whose values at two wavelengths correlate as exp(−|Δλ| /
    `CORRELATED`).
    """
    nm = standard.wavelengths
    light = standard.light
    sensitivities = camera.at(nm)
    weights = sensitivities * standard.power[:, None]
    if not (weights.sum(axis=0) > 0).all():
        problem = (
            f"every channel must respond to {light.name} within {nm[0]:g}–{nm[-1]:g} nm"
        )
        raise OptionError(problem, hint=LAYOUT)
    # With C the correlation, B the balanced camera and X the weights of XYZ: M = B C Xᵀ
    # (X C Xᵀ)⁻¹.
    balanced = (weights / weights.sum(axis=0)).T
    expected = np.exp(-np.abs(np.subtract.outer(nm, nm)) / CORRELATED) @ light.xyz.T
    matrix = balanced @ expected @ np.linalg.inv(light.xyz @ expected)
    if np.linalg.cond(matrix) > MAX_CONDITION:
        raise OptionError("the channels of a camera must have different sensitivities")
    return replace(
        standard,
        space=camera.name,
        xyz_to_rgb=matrix / (matrix @ light.white)[:, None],
        decoding=np.arange(256) / 255,
        sensitivities=sensitivities,
    )
