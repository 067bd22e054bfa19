"""Colours on a display: linear RGB of spectral powers without adaptation, and their perceptual derivatives."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.delta_e import lab_jacobian
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

MID_GREY = 0.18
"""Luminance to which single colours are exposed, so that dark colours have the weight of bright ones."""


def screen_matrix(sensor: Sensor) -> Array:
    """Matrix Q (3, N) from spectral power to linear RGB, without adaptation: the colour of a light remains visible.

    A flat power of 1 has luminance 1. The sensor's illuminant at luminance 1 is white, (1, 1, 1).
    """
    return sensor.xyz_to_rgb @ (sensor.cmfs / sensor.cmfs[:, 1].sum()).T


def luminance(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Y (…) of linear RGB (…, 3)."""
    return sensor.xyz(rgb)[..., 1]


def exposure(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Factor (…) that takes linear RGB (…, 3) to the luminance of mid-grey."""
    return np.asarray(MID_GREY / luminance(sensor, rgb))


def lab_per_rgb(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Derivative (…, 3, 3) of L*a*b* by linear RGB (…, 3) exposed to mid-grey; the last axis is RGB."""
    rgb = np.asarray(rgb, dtype=float)
    gain = exposure(sensor, rgb)[..., None]
    jacobian = lab_jacobian(sensor.xyz(rgb * gain), sensor.light.white)
    return jacobian @ np.linalg.inv(sensor.xyz_to_rgb) * gain[..., None]
