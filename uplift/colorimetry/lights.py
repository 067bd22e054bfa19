"""Illuminants for each purpose, by the names of colour-science, and sets of lamps.

Temperatures such as 3200K are names too: from 4000K to 25000K of CIE daylight (CIE 15:2004, 3.1) of this nominal
temperature, as D65 is 6500K, and below, from 1000K, of black bodies.
"""

import re

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

COMMON_NAMES = {"daylight": "D65", "tungsten": "A", "fluorescent": "FL2", "led": "LED-B3", "sodium": "HP1"}
"""Names of illuminants for readers who do not know those of the CIE."""
TEMPERATURES = (1000.0, 25000.0)
"""Range of colour temperatures in K."""
DAYLIGHT_FROM = 4000.0
"""Lowest colour temperature in K of CIE daylight (CIE 15:2004, 3.1)."""
NOMINAL = 1.4388 / 1.4380
"""Colour temperatures of CIE daylight over nominal ones, which refer to an older radiation constant."""
SECOND_RADIATION_CONSTANT = 1.4387768775e7
"""h c / k in nm K."""

DEFAULT_ILLUMINANT = "D65"
"""Illuminant that RGB refers to by default."""

ERROR_ILLUMINANT = "A"
"""Illuminant of the standard errors that a cube stores."""

SCENE_LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3")
"""Lights under which entries keep their measured colours, and lights of a scene that names none."""

REPORT_LIGHTS = ("D65", "A", "FL2", "FL7", "FL11", "LED-B3")
"""Lights of reports and of the study of moments."""

RELIGHT_LIGHTS = ("A", "FL11", "HP1")
"""Lights under which products of RGB go visibly wrong: warm, three narrow bands, and nearly one wavelength."""

DESCRIPTIONS = {
    "A": "tungsten", "D50": "warm daylight", "D65": "daylight", "HP1": "sodium lamp",
    "FL2": "fluorescent", "FL7": "broadband fluorescent", "FL11": "three-band fluorescent",
    "LED-B3": "white LED", "LED-RGB1": "red, green and blue LED",
}  # fmt: skip
"""Words for readers who do not know the names."""

CHART_LIGHTS = REPORT_LIGHTS[1:]
"""Lights of the chart of methods: all of a report but the illuminant that colours are matched under."""

HELD_OUT_LIGHTS = (*CHART_LIGHTS, "LED-RGB1", "HP1")
"""Lights of errors on held-out measurements, which include extreme spectra."""

REGRESSION_LIGHTS = ("D65", "A", "FL11")
"""Lights of the regression check of stored cubes: smooth, reddish, and three narrow bands."""

PALETTE_LIGHTS = ("D65", "A", "D50", "E")
"""Smooth lights that the standard factor model of palettes is fitted to."""

NARROW_BAND_LIGHT = "FL11"
"""Light of the sensitivity study: its narrow bands expose differences between spectra."""

KMENT_LIGHTS = {"smooth": ("A", "B", "C"), "spiky": ("FL2", "FL7", "FL11")}
"""Sets of lights of Kment 2011, 5.4: non-fluorescent and fluorescent."""

STANDARD_ILLUMINANTS = ("A", "D50", "D55", "D65", "D75")
"""Illuminants that an emission table without an atlas returns exactly."""


def standard_name(name: str) -> tuple[str, float | None]:
    """Return the name of an illuminant for one of `COMMON_NAMES`, and its colour temperature, as of ``3200K``.

    Other names stay, and have none. `OptionError` for a temperature out of range.

    >>> standard_name("Tungsten"), standard_name("3200 k"), standard_name("FL11")
    (('A', None), ('3200K', 3200.0), ('FL11', None))
    """
    found = re.fullmatch(r"(\d{1,6}(?:\.\d{1,3})?) ?K", name, re.IGNORECASE)
    if found is None:
        return COMMON_NAMES.get(name.casefold(), name), None
    kelvin = float(found[1])
    if not TEMPERATURES[0] <= kelvin <= TEMPERATURES[1]:
        raise OptionError(
            f"a colour temperature must be from 1000K to 25000K, got {name}", hint="black bodies end at 4000K"
        )
    return f"{kelvin:g}K", kelvin


def black_body(kelvin: float, wavelengths: Array) -> Array:
    """Compute the relative power of a black body by Planck's law. Shapes: ``wavelengths`` (N,) nm → (N,)."""
    return np.asarray(wavelengths**-5 / np.expm1(SECOND_RADIATION_CONSTANT / (wavelengths * kelvin)) * 1e15)
