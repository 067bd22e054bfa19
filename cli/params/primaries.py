"""Displays as they are typed: a space by name, or chromaticities of red, green, blue and white."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.colorimetry.gamut import Primaries

NUMBERS = re.compile(r"[-+\d.eE,;\s]+")


def parse_primaries(text: str) -> Primaries:
    """From 'P3-D65', or '0.68,0.32 0.265,0.69 0.15,0.06 0.3127,0.329'.

    Raises `UnknownNameError`, and `OptionError` for numbers that are no display.
    """
    from uplift.colorimetry.gamut import Primaries
    from uplift.common.errors import OptionError

    if not NUMBERS.fullmatch(text):
        from uplift.colorimetry.observer import primaries

        return primaries(text)
    try:
        numbers = [float(word) for word in re.split(r"[,;\s]+", text.strip())]
    except ValueError as error:
        problem = f"primaries '{text}' are not clear"
        raise OptionError(problem, hint="name a space, or x,y of red, green, blue and white") from error
    return Primaries.of(numbers)
