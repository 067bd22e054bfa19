"""Photographs of one thing under several lights: which numbers a reflectance has in
each of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA, Camera
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, unknown_name

BALANCES = ("light", "camera", "none")
"""Which white is (1, 1, 1): that of the light, by Bradford; the same by a factor for
each channel, as cameras and grey cards do; or that of the cube's light, so that
colours have the tint of the light.
"""
SAME = 1e-9
"""Difference of matrices of the same photograph."""


class Noise(NamedTuple):
    """Standard deviation of linear RGB in photographs.

    Parameters
    ----------
    share : float
        Share of each value, in [0, 1).
    floor : float
        What is added to it in squares, linear RGB in [0, 1).
    """

    share: float = 0.0
    floor: float = 0.0

    def variance(self, values: Array) -> Array:
        """Compute the variance of values.

        Parameters
        ----------
        values : ndarray
            Linear RGB.

        Returns
        -------
        ndarray
            Variances, of the same shape.
        """
        return (self.share * values) ** 2 + self.floor**2


def rounding_noise(steps: int) -> Noise:
    """Return the noise of rounding encoded values to whole steps up to this one.

    It is 1 / √12 of a step, which in sRGB is 2.3 / ``steps`` of a linear value of 1,
    and more of a darker one.
    """
    return Noise(1 / steps, 0.03 / steps)


@dataclass(frozen=True, eq=False, repr=False)
class Photograph:
    """A further photograph, by `photograph`.

    Parameters
    ----------
    light : str
        Name of its light.
    matrix : ndarray, shape (3, N)
        From reflectances at the wavelengths of the cube's sensor to linear RGB.
    """

    light: str
    matrix: Array


def photograph(
    sensor: Sensor,
    light: Illuminant,
    camera: Camera | str | None = None,
    balance: str = "light",
) -> Photograph:
    """Describe a photograph of what a cube with this sensor answers.

    Parameters
    ----------
    sensor : Sensor
        That of the cube. The RGB of the photograph are of its space or, for a camera,
        raw values of this camera.
    light : str or Lamp
        Light of the photograph, as for `uplift.colorimetry.observer.light`.
    camera : str or Camera, optional
        Camera whose raw values the photograph has, in place of RGB of the space.
    balance : {"light", "camera", "none"}
        Whether the white of the light is white, as `uplift relight` writes it (Bradford
        for RGB, a factor for each channel of a camera); the same by a factor for each
        channel of RGB; or whether that of the cube's light is white.

    Returns
    -------
    Photograph

    Raises
    ------
    OptionError
        The photograph is that of the cube: same light and same camera or space.
    UnknownNameError
        The light, the camera or the balance is unknown.
    """
    if balance not in BALANCES:
        raise unknown_name(balance, BALANCES, "balance")
    if camera is not None:
        lit = observer.sensor(CAMERA, light, camera, sensor.range)
        tint = _tint(lit, sensor)
    elif sensor.sensitivities is not None:
        power = observer.sensor("sRGB", light, wavelengths=sensor.range).power
        name = observer.light(light, observer.DEFAULT_OBSERVER, *sensor.range).name
        lit = replace(sensor, power=power, illuminant=name)
        tint = _tint(lit, sensor)
    else:
        lit = observer.sensor(sensor.space, light, sensor.observer, sensor.range)
        unbalanced = sensor.xyz_to_rgb @ lit.light.xyz
        tint = unbalanced @ np.linalg.pinv(lit.matrix)
    matrix = lit.matrix
    if balance != "light":
        matrix = tint @ lit.matrix
    if balance == "camera":
        matrix = matrix / matrix.sum(axis=1, keepdims=True)
    if np.abs(matrix - sensor.matrix).max() <= SAME:
        raise OptionError(
            f"a further photograph under {lit.illuminant} adds nothing: this is the "
            "light of the cube",
            hint="give one under another light, or of another camera",
        )
    return Photograph(lit.illuminant, matrix)


def _tint(lit: Sensor, sensor: Sensor) -> Array:
    """Matrix (3, 3) from raw values, balanced to the light, to those that white under
    the light of the cube would balance; green stays.
    """
    assert lit.sensitivities is not None
    response = lit.sensitivities.T @ lit.power
    balanced = lit.sensitivities.T @ sensor.power
    gain = response / balanced
    return np.diag(gain / gain[1])


def check_different(photographs: Sequence[Photograph]) -> None:
    """Raise `OptionError` for two photographs of one light."""
    for number, first in enumerate(photographs):
        for second in photographs[number + 1 :]:
            if np.abs(first.matrix - second.matrix).max() <= SAME:
                raise OptionError(
                    f"two photographs have the light {first.light}",
                    hint="average them first, or leave one out",
                )
