"""Wavelengths as they are typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.common.arrays import Array

MOST = 100_000


def parse_wavelengths(text: str | None) -> Array | None:
    """'380:780:5' (end included) or '450,550,650' → (N,) nm. Raises `OptionError`."""
    import numpy as np

    if text is None:
        return None
    try:
        if ":" not in text:
            return np.array([float(part) for part in text.split(",")])
        start, end, step = (float(part) for part in text.split(":"))
        count = int((end - start) / step + 1e-9) + 1
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise _unclear(text) from error
    if not (step > 0 and end >= start and count <= MOST):
        raise _unclear(text)
    return start + step * np.arange(count, dtype=float)


def _unclear(text: str) -> Exception:
    from uplift.common.errors import OptionError

    return OptionError(
        f"wavelengths '{text}' are not clear", hint="write START:END:STEP or a list, in nm: 380:780:5"
    )
