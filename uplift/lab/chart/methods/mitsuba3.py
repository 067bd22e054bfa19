"""Sigmoids of quadratic polynomials from the table of Mitsuba 3.

Domain: linear sRGB in [0, 1]. Range: reflectance in [0, 1] at any wavelengths. The table of 64 points along each edge
is part of Mitsuba; it is queried from Python with one colour per call.

References
----------
Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", Computer Graphics Forum
38(2).
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, NotInstalledError, PreparedMethod
from uplift.lab.chart.task import Task
from uplift.models.sigmoid import evaluate_unscaled

VARIANT = "scalar_spectral"
"""The spectral variant that does not need LLVM."""
TABLE = Path("data", "srgb.coeff")


def prepare(task: Task) -> PreparedMethod:
    """Load Mitsuba and locate its table."""
    return PreparedMethod(spectra, (Path(_mitsuba().__file__).parent / TABLE).stat().st_size, None)


def spectra(rgb: Array, wavelengths: Array) -> Array:
    """Return the reflectances (n, N) that Mitsuba gives linear sRGB (n, 3) at wavelengths (N,) in nm."""
    mitsuba = _mitsuba()
    coefficients = [mitsuba.srgb_model_fetch(colour) for colour in rgb.tolist()]
    return evaluate_unscaled(np.array(coefficients, dtype=float), wavelengths)


def _mitsuba() -> Any:
    try:
        mitsuba = import_module("mitsuba")
    except ImportError as error:
        raise NotInstalledError("Mitsuba is not installed: pip install 'spectral-uplift[peers]'") from error
    mitsuba.set_variant(VARIANT)
    return mitsuba


FAMILIES = (
    Family(
        "Mitsuba 3",
        "Jakob et al., Mitsuba 3, the table of Jakob & Hanika 2019 for sRGB",
        "#f08c2e",
        (
            Method(
                "mitsuba3-table",
                "Mitsuba 3, table of 64",
                prepare,
                Claims(round_trip=0.1),
                batch=False,
                note="coefficients from Python, one colour per call; spectra by numpy",
            ),
        ),
    ),
)
