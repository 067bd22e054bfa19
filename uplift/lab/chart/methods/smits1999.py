"""Spectra from seven hand-made basis spectra of ten bins.

Domain: RGB in [0, 1]; made for an equal-energy white, used with linear sRGB as renderers do. Range: reflectance up to
1.015 at 380 to 720 nm, interpolated linearly between the centres of the bins. The table is that of colour-science.

References
----------
Smits 1999, "An RGB-to-spectrum conversion for reflectances", Journal of Graphics Tools 4(4).
"""

from __future__ import annotations

from functools import cache

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import (
    Claims,
    Family,
    Method,
    PreparedMethod,
    Task,
    in_both_types,
    nbytes,
    stated_sensor,
    stopwatch,
)

SECONDARIES, PRIMARIES = ("cyan", "magenta", "yellow"), ("red", "green", "blue")
"""Basis spectra by the smallest and by the largest component of RGB."""


def prepare(task: Task, dtype: str = "float64") -> PreparedMethod:
    """Prepare the table."""
    table = colour_science().recovery.SDS_SMITS1999
    centres = table["white"].wavelengths
    (white, secondaries, primaries), seconds = stopwatch(lambda: _spectra(dtype))

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        order = rgb.argsort(axis=1)
        low, middle, high = np.take_along_axis(rgb, order, axis=1).T[..., None]
        bins = low * white + (middle - low) * secondaries[order[:, 0]] + (high - middle) * primaries[order[:, 2]]
        return bins @ _linear(wavelengths, centres).astype(dtype, copy=False)

    return PreparedMethod(uplift, nbytes((white, secondaries, primaries)), load_s=seconds)


def _spectra(dtype: str) -> tuple[Array, Array, Array]:
    """Spectra of white (1, 10), of the secondary and of the primary colours (3, 10)."""
    table = colour_science().recovery.SDS_SMITS1999
    white, secondaries, primaries = (
        np.stack([table[name].values for name in names]).astype(dtype) for names in (("white",), SECONDARIES, PRIMARIES)
    )
    return white, secondaries, primaries


@cache
def judge() -> Sensor:
    """Return the sensor of the stated space, sRGB primaries with an equal-energy white."""
    space = colour_science().recovery.smits1999.RGB_COLOURSPACE_SMITS1999
    return stated_sensor(space.matrix_XYZ_to_RGB, space.whitepoint_name)


def _linear(wavelengths: Array, centres: Array) -> Array:
    """Weights (10, N) of the bins in a spectrum that is linear between their centres."""
    return np.stack([np.interp(wavelengths, centres, row) for row in np.eye(len(centres))])


FAMILIES = (
    Family(
        "Smits 1999",
        "Smits, An RGB-to-spectrum conversion for reflectances, Journal of Graphics Tools 4(4), 1999",
        "#7a9a1d",
        in_both_types(
            Method(
                "smits1999",
                "Smits 1999",
                prepare,
                Claims(max=1.02),
                judge=judge,
                quick=True,
                note="table of colour-science, used with sRGB; reflectances up to 1.015",
            ),
            prepare,
        ),
    ),
)
