"""Lights: relative spectral powers, scaled so that the perfect reflector has luminance 1 under them."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

C2 = 1.438776877e7
"""Second radiation constant in nm K (CODATA 2018)."""
COLDEST, HOTTEST = 500.0, 1e6
"""Kelvin: what glows visibly, and what looks no bluer however hot."""


def scaled(sensor: Sensor, power: Array) -> Array:
    """Power (…, N) with luminance 1; the power must be seen at all."""
    weights = sensor.cmfs[:, 1]
    return power * (weights.sum() / (power @ weights))[..., None]


def illuminant(sensor: Sensor, name: str) -> Array:
    """(N,) power of an illuminant as colour-science names it. Raises `UnknownNameError`."""
    start, end = sensor.wavelengths[[0, -1]]
    step = sensor.wavelengths[1] - start
    return scaled(sensor, observer.illuminant_spd(name, float(start), float(end), float(step)))


def planck(sensor: Sensor, kelvin: float) -> Array:
    """(N,) power of a black body (Bergner, eq. 25). Raises `OptionError`."""
    if not COLDEST <= kelvin <= HOTTEST:
        raise OptionError(
            f"a black body of {kelvin:g} K", hint=f"give a temperature of {COLDEST:g} to {HOTTEST:g} K"
        )
    at = sensor.wavelengths
    reference = 560.0  # where luminance is; keeps the powers near 1
    power = (reference / at) ** 5 * np.expm1(C2 / (reference * kelvin)) / np.expm1(C2 / (at * kelvin))
    return scaled(sensor, power)
