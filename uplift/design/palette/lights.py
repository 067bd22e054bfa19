"""Spectral powers of lights, scaled so that the perfect reflector has luminance 1."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

C2 = 1.438776877e7
"""Second radiation constant in nm K (CODATA 2018)."""
MIN_KELVIN, MAX_KELVIN = 500.0, 1e6
"""Below, a black body has no visible power; above, its colour no longer changes."""
REFERENCE_NM = 560.0
"""Wavelength of unit power before scaling, which keeps all powers near 1."""


def scale_to_unit_luminance(sensor: Sensor, power: Array) -> Array:
    """Power (…, N) with luminance 1; its luminance must not be 0."""
    weights = sensor.cmfs[:, 1]
    return power * (weights.sum() / (power @ weights))[..., None]


def illuminant(sensor: Sensor, name: str) -> Array:
    """Power (N,) of an illuminant by its name in colour-science. Raises `UnknownNameError`."""
    start, end = sensor.wavelengths[[0, -1]]
    step = sensor.wavelengths[1] - start
    power = observer.illuminant_spd(name, float(start), float(end), float(step))
    return scale_to_unit_luminance(sensor, power)


def planck(sensor: Sensor, kelvin: float) -> Array:
    """Power (N,) of a black body (Bergner, eq. 25). Raises `OptionError`."""
    if not MIN_KELVIN <= kelvin <= MAX_KELVIN:
        raise OptionError(
            f"temperature must be in [{MIN_KELVIN:g}, {MAX_KELVIN:g}] K, got {kelvin:g}",
            code="temperature-out-of-range",
            hint="give the temperature in kelvin",
        )
    nm = sensor.wavelengths
    ratio = np.expm1(C2 / (REFERENCE_NM * kelvin)) / np.expm1(C2 / (nm * kelvin))
    return scale_to_unit_luminance(sensor, (REFERENCE_NM / nm) ** 5 * ratio)
