"""What a text of a file states about its numbers: their scale, and the unit of
wavelengths.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.document import SourceLocation, truncate
from uplift.common.arrays import Array
from uplift.extras.formats.quantities import TABLE, any_of, plain_text

PERCENT = 100.0
"""Divisor of values in percent."""
TEN_THOUSAND = 1e4
"""Divisor of reflectances that remote sensing stores as whole numbers."""


_SCALES = {row["divisor"]: any_of(row["patterns"]) for row in TABLE["scale"]}
_SCALED = any_of(TABLE["words"]["scaled"])
_UNSCALED = any_of(TABLE["words"]["not-scaled"])
_ONLY_SCALE = any_of(
    [r"\W*(?:in |as )?(?:%|percent(?:age)?|per cent|pct|fractions?)\W*"]
)
NANOMETRE, MICROMETRE, METRE = 1.0, 1e3, 1e9
"""Lengths in nm."""
WAVE_NUMBER = -1e7
"""Unit 1/cm, below 0: the wavelength in nm is 1e7 divided by the wave number."""
FEW = 10
"""Numbers that may be wavelengths in micrometres without a statement."""
_UNITS = {row["nm"]: any_of(row["patterns"]) for row in TABLE["unit"]}
_WAVES = any_of(TABLE["words"]["waves"])


@dataclass(frozen=True)
class Scale:
    """The divisor of values that a file states, in the words of ``text``."""

    divisor: float
    text: str
    is_assumed: bool = False
    """Whether it is a likely reading of the numbers, and no statement."""


def label_scale(text: str) -> Scale | None:
    """Return the scale that the label of values states; None if it states none. '50 %'
    is a part of a name.

    >>> scales = map(label_scale, ("R% 400", "grey 50%", "R × 10000"))
    >>> [scale and scale.divisor for scale in scales]
    [100.0, None, 10000.0]
    """
    for divisor, pattern in _SCALES.items():
        if pattern.search(text):
            return Scale(divisor, text)
    return None


def remark_scale(text: str) -> Scale | None:
    """Return the scale that a line of text states, if it is about the values."""
    is_about = _ONLY_SCALE.fullmatch(text) or (
        _SCALED.search(text) and not _UNSCALED.search(text)
    )
    return label_scale(text) if is_about else None


def is_plain(text: str) -> bool:
    """Whether a label of values names no sample, only what is measured: 'R [%]',
    'Reflectance', '[counts]'.
    """
    if re.fullmatch(r"[\[(].*[\])]", text):
        return True
    words = list(filter(None, re.split(r"\W+", plain_text(text).casefold())))
    has_only = all(
        word in TABLE["words"]["plain"] or word.startswith("refl") for word in words
    )
    return bool(words or text) and has_only and not (len(text) == 1 and text.isalpha())


def find_unit(text: str) -> float | None:
    """Return the unit of wavelengths that a text names: a length in nm, or
    `WAVE_NUMBER`.

    >>> [find_unit(text) for text in ("Wavelength_um", "[nm]", "cm-1", "lambda")]
    [1000.0, 1.0, -10000000.0, None]
    """
    return next(
        (unit for unit, pattern in _UNITS.items() if pattern.search(text)), None
    )


def stated_unit(text: str, location: SourceLocation) -> float:
    """Return the unit of wavelengths, see `find_unit`. Raise `AtlasError` for an
    unknown one.
    """
    unit = find_unit(text)
    if unit is None:
        problem = (
            "wavelengths must be in nanometers, micrometers or 1/cm, got "
            f"'{truncate(text)}'"
        )
        raise location.error(problem, "export the file with wavelengths in nm")
    return unit


def remark_unit(texts: Iterable[str]) -> float | None:
    """Return the unit that the first of several lines about wavelengths states."""
    found = (find_unit(text) for text in texts if _WAVES.search(text))
    return next((unit for unit in found if unit is not None), None)


def names_wavelengths(text: str) -> bool:
    """Whether a label is that of wavelengths, and not of one of them, such
    as 'nm400'.
    """
    if re.search(r"\d\d", text):
        return False
    return (
        bool(_WAVES.search(text)) or find_unit(text) is not None or text in ("x", "X")
    )


def to_nm(numbers: ArrayLike, unit: float) -> Array:
    """Convert wavelengths in a unit, or wave numbers in 1/cm, to nm."""
    numbers = np.asarray(numbers, dtype=float)
    with np.errstate(all="ignore"):  # wavelengths that are not finite are refused later
        return -unit / numbers if unit == WAVE_NUMBER else unit * numbers


def unit_by_values(numbers: ArrayLike) -> float:
    """Return the unit of ascending or descending wavelengths without a statement:
    micrometres and metres are plain.
    """
    numbers = np.asarray(numbers, dtype=float)
    low = numbers.min()
    high = numbers.max()
    is_sorted = len(set(np.sign(np.diff(numbers)))) == 1
    if is_sorted and len(numbers) >= FEW and 0.1 <= low <= 0.4 and 0.7 <= high <= 100:
        return MICROMETRE
    return METRE if low >= 1e-7 and high <= 1e-4 else NANOMETRE
