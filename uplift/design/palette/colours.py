"""Colours as a screen shows them: linear RGB of any power that reaches the eye, and how far two lie apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.delta_e import lab_jacobian
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

GREY = 0.18
"""Luminance that a picture of one colour is exposed to, so that dark colours count as much as bright ones."""


def screen_matrix(sensor: Sensor) -> Array:
    """(3, N) Q: ``Q @ power`` is linear RGB; nothing is adapted, so that the colour of a light is seen.

    A flat power of 1 has luminance 1, and the sensor's illuminant at luminance 1 is white (1, 1, 1).
    """
    return sensor.xyz_to_rgb @ (sensor.cmfs / sensor.cmfs[:, 1].sum()).T


def luminance(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Y (…) of linear RGB (…, 3)."""
    return sensor.xyz(rgb)[..., 1]


def exposure(sensor: Sensor, rgb: ArrayLike) -> Array:
    """(…) the factor that takes linear RGB (…, 3) to mid-grey luminance."""
    return np.asarray(GREY / luminance(sensor, rgb))


def lab_per_rgb(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Derivative (…, 3, 3) of L*a*b* by linear RGB (…, 3), exposed to mid-grey; the last axis is RGB."""
    rgb = np.asarray(rgb, dtype=float)
    gain = exposure(sensor, rgb)[..., None]
    slope = lab_jacobian(sensor.xyz(rgb * gain), sensor.light.white)
    return slope @ np.linalg.inv(sensor.xyz_to_rgb) * gain[..., None]
