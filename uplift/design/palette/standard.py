"""The factor model for any palette: made from what the package carries, so that it is the same everywhere."""

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
"""Linear R, G and B of the colours whose uplifted spectra stand for all materials; dark ones lie closer."""


def standard_model(sensor: Sensor, count: int = 7) -> FactorModel:
    """A factor model of the package's own cube's spectra under smooth lights. Raises `OptionError`."""
    return factor_model(
        sensor, _materials(sensor), np.array([illuminant(sensor, name) for name in PALETTE_LIGHTS]), count
    )


def _materials(sensor: Sensor) -> Array:
    """(125, N)."""
    colours = np.array(list(itertools.product(NODES, repeat=3)))
    return lookup.load().reflectance(colours, sensor.wavelengths)
