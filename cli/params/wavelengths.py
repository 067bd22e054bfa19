"""Wavelengths: ``START:END:STEP`` or a list."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from uplift.common.text import format_value, parse_float

if TYPE_CHECKING:
    from uplift.common.arrays import Array

MAX_COUNT = 100_000


def parse_wavelengths(text: str | None) -> Array | None:
    """Parse '380:780:5' (end included) or '450,550,650' into nm, shape (N,). Raises `OptionError`."""
    import numpy as np

    if text is None:
        return None
    try:
        if ":" not in text:
            return np.array([parse_float(part) for part in text.split(",")])
        start, end, step = (parse_float(part) for part in text.split(":"))
        count = int((end - start) / step + 1e-9) + 1
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise _unreadable(text) from error
    if not (0 < step < math.inf and end >= start and count <= MAX_COUNT):
        raise _unreadable(text)
    return start + step * np.arange(count, dtype=float)


def parse_range(text: str) -> tuple[float, float]:
    """Parse '360:830', a first and a last wavelength in nm. Raises `OptionError`."""
    try:
        start, end = (parse_float(part) for part in text.split(":"))
    except ValueError as error:
        from uplift.common.errors import OptionError

        raise OptionError(
            f"a range must be START:END in nm, got {format_value(text)}",
            code="invalid-range",
            hint="write for example 360:830",
        ) from error
    return start, end


def _unreadable(text: str) -> Exception:
    from uplift.common.errors import OptionError

    return OptionError(
        f"wavelengths must be START:END:STEP or a list, got {format_value(text)}",
        code="invalid-wavelengths",
        hint="write for example 380:780:5 or 450,550,650, in nm",
    )
