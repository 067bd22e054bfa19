"""Primaries: an RGB space by name, or chromaticities of red, green, blue and white."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from uplift.common.number_text import parse_float
from uplift.common.quoting import format_value

if TYPE_CHECKING:
    from uplift.colorimetry.gamut import Primaries

NUMBERS = re.compile(r"[-+\d.eE,;\s]+")


def parse_primaries(text: str) -> Primaries:
    """Parse 'P3-D65', or '0.68,0.32 0.265,0.69 0.15,0.06 0.3127,0.329'.

    Raises `UnknownNameError` for an unknown space and `OptionError` for chromaticities that are not those of a display.
    """
    from uplift.colorimetry.gamut import Primaries
    from uplift.common.errors import OptionError

    if not NUMBERS.fullmatch(text):
        from uplift.colorimetry.observer import primaries

        return primaries(text)
    try:
        numbers = [parse_float(word) for word in re.split(r"[,;\s]+", text.strip())]
    except ValueError as error:
        raise OptionError(
            f"primaries must be the name of a space or eight numbers, got {format_value(text)}",
            code="invalid-primaries",
            hint="give x,y of red, green, blue and white",
        ) from error
    return Primaries.of(numbers)
