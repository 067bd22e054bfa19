"""Illuminants for each purpose, by the names of colour-science, and sets of lamps.

Temperatures such as 3200K are names too: from 4000K to 25000K of CIE daylight (CIE
15:2004, 3.1) of this nominal temperature, as D65 is 6500K, and below, from 1000K, of
black bodies. A `Lamp` is a measured light in place of a name.
"""

import functools
import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, as_nm
from uplift.common.errors import OptionError

COMMON_NAMES = {
    "daylight": "D65",
    "tungsten": "A",
    "fluorescent": "FL2",
    "led": "LED-B3",
    "sodium": "HP1",
    "cwf": "FL2",
    "tl83": "FL12",
    "tl84": "FL11",
    "tl85": "FL10",
}
"""Names of illuminants for readers who do not know those of the CIE, and trade names
of lamps in light booths, whose types they are.
"""
VISIBLE = (380.0, 780.0)
"""Wavelengths in nm, some of which a lamp must have."""
TEMPERATURES = (1000.0, 25000.0)
"""Range of colour temperatures in K."""
DAYLIGHT_FROM = 4000.0
"""Lowest colour temperature in K of CIE daylight (CIE 15:2004, 3.1)."""
NOMINAL = 1.4388 / 1.4380
"""Colour temperatures of CIE daylight over nominal ones, which refer to an older
radiation constant.
"""
SECOND_RADIATION_CONSTANT = 1.4387768775e7
"""h c / k in nm K."""

DEFAULT_ILLUMINANT = "D65"
"""Illuminant that RGB refers to by default."""

ERROR_ILLUMINANT = "A"
"""Illuminant of the standard errors that a cube stores."""

SCENE_LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3")
"""Lights under which entries keep their measured colours, and lights of a scene that
names none.
"""


@dataclass(frozen=True)
class Lamp:
    """A measured light, which functions take in place of the name of an illuminant;
    `uplift.read_lamp` reads files.

    Parameters
    ----------
    name : str
        Name in results.
    wavelengths : tuple of float
        At least two wavelengths in nm, ascending.
    power : tuple of float
        Relative spectral power at the wavelengths, not negative, not all 0. Outside it
        keeps its first and last value.

    Raises
    ------
    OptionError
        The wavelengths or the power are not as described.

    Examples
    --------
    >>> Lamp("lamp", (400, 600, 700), (0, 2, 1)).at([350, 500, 600, 800]).tolist()
    [0.0, 1.0, 2.0, 1.0]
    """

    name: str
    wavelengths: tuple[float, ...]
    power: tuple[float, ...]

    def __post_init__(self) -> None:
        wavelengths = tuple(map(float, self.wavelengths))
        power = tuple(map(float, self.power))
        problem = ""
        if not len(wavelengths) == len(power) >= 2:
            problem = (
                "must have at least 2 wavelengths and as many powers, got "
                f"{len(wavelengths)} and {len(power)}"
            )
        elif not all(map(math.isfinite, (*wavelengths, *power))):
            problem = "must have finite wavelengths and powers"
        elif (np.diff(wavelengths) <= 0).any():
            problem = "must have ascending wavelengths"
        elif wavelengths[-1] < VISIBLE[0] or wavelengths[0] > VISIBLE[1]:
            problem = (
                f"must have wavelengths within {VISIBLE[0]:g}–{VISIBLE[1]:g} nm, got "
                f"{wavelengths[0]:g}–{wavelengths[-1]:g} nm"
            )
        elif min(power) < 0 or max(power) == 0:
            problem = (
                "must have powers of at least 0, one of them above, got "
                f"{min(power):g} to {max(power):g}"
            )
        if problem:
            raise OptionError(f"the lamp '{self.name}' {problem}")
        object.__setattr__(self, "wavelengths", wavelengths)
        object.__setattr__(self, "power", power)

    def __str__(self) -> str:
        return self.name

    def at(self, wavelengths: ArrayLike) -> Array:
        """Sample the power at evenly spaced wavelengths (N,) in nm.

        Powers that are measured at a smaller step are averaged with triangular weights,
        so that no narrow line is lost. Others are interpolated linearly.
        """
        nm = as_nm(wavelengths)
        step = np.diff(nm[:2]).sum()
        measured_step = float(np.median(np.diff(self.wavelengths)))
        count = math.ceil(step / measured_step - 1e-6) if step > measured_step else 1
        offsets = step / count * np.arange(1 - count, count)
        weights = count - np.abs(np.arange(1 - count, count))
        shifted = np.interp(nm[:, None] + offsets, self.wavelengths, self.power)
        return shifted @ weights / weights.sum()


Illuminant = str | Lamp
"""The name of an illuminant, or a measured light."""


@functools.cache
def standard_name(name: str) -> tuple[str, float | None]:
    """Return the name of an illuminant for one of `COMMON_NAMES`, and its colour
    temperature, as of ``3200K``.

    Other names stay, and have none. `OptionError` for a temperature out of range.

    >>> standard_name("Tungsten"), standard_name("3200 k"), standard_name("TL-84")
    (('A', None), ('3200K', 3200.0), ('FL11', None))
    """
    match = re.fullmatch(r"(\d{1,6}(?:\.\d{1,3})?) ?K", name, re.IGNORECASE)
    if match is None:
        return COMMON_NAMES.get(re.sub("[- ]", "", name.casefold()), name), None
    kelvin = float(match[1])
    if not TEMPERATURES[0] <= kelvin <= TEMPERATURES[1]:
        raise OptionError(
            f"a colour temperature must be from 1000K to 25000K, got {name}",
            hint="black bodies end at 4000K",
        )
    return f"{kelvin:g}K", kelvin


def black_body(kelvin: float, wavelengths: Array) -> Array:
    """Compute the relative power of a black body by Planck's law. Shapes:
    ``wavelengths`` (N,) nm → (N,).
    """
    return np.asarray(
        wavelengths**-5
        / np.expm1(SECOND_RADIATION_CONSTANT / (wavelengths * kelvin))
        * 1e15
    )
