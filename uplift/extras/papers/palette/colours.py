"""Colours on a display: linear RGB of spectral powers without adaptation, their
derivatives, and powers of lights.
"""

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab_jacobian
from uplift.colorimetry.illuminants import Illuminant, black_body
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

# luminance to which single colours are exposed, so that dark colours have the weight of
# bright ones
MID_GREY = 0.18
MIN_KELVIN = 500.0  # below, a black body has no visible power
MAX_KELVIN = 1e6  # above, the colour of a black body no longer changes


def screen_matrix(sensor: Sensor) -> Array:
    """Return the matrix Q (3, N) from power to linear RGB, without adaptation: the
    colour of a light remains visible.

    A flat power of 1 has luminance 1; the sensor's illuminant at luminance 1 is white.
    """
    return sensor.xyz_to_rgb @ (sensor.cmfs / sensor.cmfs[:, 1].sum()).T


def exposure(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Return the factor (…) that takes linear RGB (…, 3) to the luminance
    of mid-grey.
    """
    return MID_GREY / sensor.xyz(rgb)[..., 1]


def lab_per_rgb(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Return the derivative (…, 3, 3) of L*a*b* by linear RGB (…, 3) exposed to
    mid-grey; the last axis is RGB.
    """
    rgb = np.asarray(rgb, dtype=float)
    gain = exposure(sensor, rgb)[..., None]
    jacobian = lab_jacobian(sensor.xyz(rgb * gain), sensor.light.white)
    return jacobian @ np.linalg.inv(sensor.xyz_to_rgb) * gain[..., None]


def illuminant(sensor: Sensor, name: Illuminant) -> Array:
    """Compute the spectral power of an illuminant.

    Parameters
    ----------
    sensor : Sensor
        Gives the wavelengths.
    name : str or Lamp
        Name of the illuminant in colour-science, or a measured lamp.

    Returns
    -------
    ndarray, shape (N,)
        Power under which the perfect reflector has luminance 1.
    """
    start, end = sensor.wavelengths[[0, -1]]
    step = sensor.wavelengths[1] - start
    return _scale(
        sensor, observer.illuminant_spd(name, float(start), float(end), float(step))
    )


def planck(sensor: Sensor, kelvin: float) -> Array:
    """Return the power (N,) of a black body (Bergner, eq. 25), of luminance 1."""
    return _scale(sensor, black_body(kelvin, sensor.wavelengths))


def _scale(sensor: Sensor, power: Array) -> Array:
    """Scale a power (N,) to luminance 1."""
    weights = sensor.cmfs[:, 1]
    return power * (weights.sum() / (power @ weights))
