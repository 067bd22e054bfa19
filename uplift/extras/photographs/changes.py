"""Spectra that are changed without their colour: kept in [0, 1], and moved back to the
colour.
"""

import numpy as np

from uplift.common.arrays import Array, Mask, Values
from uplift.cube.data import CubeData
from uplift.lookup.refine import with_colours

OVERSHOOT = 0.2
"""Reflectance by which a spectrum may leave [0, 1] before it is changed less."""


def changed_spectra(
    data: CubeData, expected: Values, change: Values, rgb: Array, wavelengths: Array
) -> tuple[Values, Mask]:
    """Add changes to expected spectra (n, N) of linear RGB (n, 3), and return which
    (n,) were clipped.

    The wavelengths (N,) in nm begin with those of the sensor. A spectrum that would
    leave [0, 1] is changed less, clipped, and moved back to its colour
    (docs/mathematics.md, 9).
    """
    spectra = expected + change
    clipped = (spectra.min(axis=1) < 0) | (spectra.max(axis=1) > 1)
    rows = np.flatnonzero(clipped)
    scale = _scale_within(expected[rows], change[rows])
    moved = np.clip(expected[rows] + scale[:, None] * change[rows], 0, 1)
    at_sensor = moved[:, : len(data.sensor.wavelengths)]
    spectra[rows] = with_colours(data, moved, at_sensor, rgb[rows], wavelengths)
    return spectra, clipped


def _scale_within(expected: Values, change: Values) -> Array:
    """The largest scale (n,) up to 1 of changes (n, N) of spectra that stay within
    `OVERSHOOT` of [0, 1].
    """
    room = np.where(change > 0, 1 + OVERSHOOT - expected, expected + OVERSHOOT)
    steps = np.abs(change)
    limit = np.divide(room, steps, out=np.ones_like(room), where=steps > room)
    return limit.min(axis=1)
