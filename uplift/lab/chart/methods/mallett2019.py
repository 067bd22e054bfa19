"""Spectral primary decomposition of sRGB into three smooth spectra.

Domain: linear sRGB in [0, 1] under D65. Range: reflectance in [0, 1] at 380 to 780 nm in steps of 5 nm, interpolated
linearly. The basis is that of colour-science; a spectrum is a product of matrices.

References
----------
Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance", EGSR.
"""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, Task, in_both_types, stopwatch


def prepare(task: Task, dtype: str = "float64") -> PreparedMethod:
    """Prepare the basis."""
    primaries = colour_science().recovery.MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    values, seconds = stopwatch(lambda: np.ascontiguousarray(primaries.values.T))

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        at = np.stack([np.interp(wavelengths, primaries.wavelengths, row) for row in values])
        return rgb @ at.astype(dtype, copy=False)

    return PreparedMethod(uplift, values.nbytes, load_s=seconds)


FAMILIES = (
    Family(
        "Mallett 2019",
        "Mallett & Yuksel, Spectral primary decomposition for rendering with sRGB reflectance, EGSR 2019",
        "#8e44ad",
        in_both_types(
            Method(
                "mallett2019",
                "Mallett 2019",
                prepare,
                Claims(round_trip=0.01, max=1 + 1e-6),
                quick=True,
                note="basis of colour-science, one product of matrices",
            ),
            prepare,
        ),
    ),
)
