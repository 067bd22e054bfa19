"""Standard factor model, fitted to the packaged cube's spectra under smooth lights."""

from __future__ import annotations

import itertools

import numpy as np

from uplift import lookup
from uplift.colorimetry.lights import PALETTE_LIGHTS
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.palette.factor import FactorModel, factor_model
from uplift.design.palette.lights import illuminant

NODES = np.linspace(0.02, 0.98, 5) ** 2
"""Linear R, G and B of the colours whose spectra stand for all materials; denser among dark colours."""


def standard_model(sensor: Sensor, count: int = 7) -> FactorModel:
    """Fit the standard factor model.

    Parameters
    ----------
    sensor : Sensor
        Wavelengths, observer and RGB space.
    count : int
        Number of coefficients, from 3 to 12.

    Returns
    -------
    FactorModel
        The model, the same on every machine up to rounding.

    Raises
    ------
    OptionError
        If ``count`` is not supported.
    """
    lights = np.array([illuminant(sensor, name) for name in PALETTE_LIGHTS])
    return factor_model(sensor, _materials(sensor), lights, count)


def _materials(sensor: Sensor) -> Array:
    """Uplifted spectra (125, N) of a grid of colours."""
    colours = np.array(list(itertools.product(NODES, repeat=3)))
    return lookup.load().reflectance(colours, sensor.wavelengths)
