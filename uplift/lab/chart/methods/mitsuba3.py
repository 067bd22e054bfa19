"""Mitsuba 3's table of sigmoids for sRGB, made when Mitsuba was built and looked up a colour a call."""

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
"""Of those that know spectra, the one that needs no LLVM."""
TABLE = Path("data", "srgb.coeff")


def prepare(task: Task) -> PreparedMethod:
    mitsuba = _mitsuba()

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        coefficients = [mitsuba.srgb_model_fetch(colour) for colour in rgb.tolist()]
        return evaluate_unscaled(np.array(coefficients, dtype=float), wavelengths)

    return PreparedMethod(uplift, (Path(mitsuba.__file__).parent / TABLE).stat().st_size, None)


def _mitsuba() -> Any:
    try:
        mitsuba = import_module("mitsuba")
    except ImportError as error:
        raise NotInstalledError("Mitsuba is not installed: pip install 'uplift[peers]'") from error
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
                note="looked up from Python a colour a call; the spectra of many at once by numpy",
            ),
        ),
    ),
)
