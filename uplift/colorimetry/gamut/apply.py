"""Colours as they were asked for and as they are inside [0, 1], with what was moved counted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut.boundary import Gamut
from uplift.colorimetry.gamut.mapping import MAPPINGS
from uplift.colorimetry.sensor import SLACK
from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import ColourError, OptionError

METHODS = ("error", *MAPPINGS)
"""Names of ``--out-of-gamut``."""
LARGEST = 1e300
"""Colours beyond are scaled down to this, so that no sum of three overflows."""
BLOCK = 1 << 13
"""Colours moved at a time: what they take fits into a processor's cache."""


@dataclass(frozen=True, eq=False)
class GamutMapped:
    """Linear RGB (…, 3) as ``asked`` for, and as it is inside [0, 1]; which (…,) of it was ``outside``."""

    asked: Values
    rgb: Values
    outside: Mask

    @property
    def count(self) -> int:
        """Colours that were moved."""
        return int(self.outside.sum())

    @property
    def farthest(self) -> float:
        """The largest change of a component of linear RGB."""
        return float(np.abs(self.asked[self.outside] - self.rgb[self.outside]).max(initial=0))


def map_to_gamut(rgb: ArrayLike, gamut: Gamut, way: str = "error") -> GamutMapped:
    """Linear RGB (…, 3) with what lies outside [0, 1] brought inside; all else stays, to the bit.

    Parameters
    ----------
    rgb : float32 stays float32. Rounding takes nothing outside (`uplift.colorimetry.sensor.SLACK`).
    gamut : the display that RGB are of: a cube's sensor, `Primaries`, or `SRGB`.
    way : one of `METHODS`.

    Raises
    ------
    ColourError : colours that are not finite; with ``error`` all that lie outside.
    OptionError : an unknown way.
    """
    check_method(way)
    asked = as_rgb(rgb)
    outside = np.asarray(~((asked >= -SLACK) & (asked <= 1 + SLACK)).all(axis=-1))  # NaN is
    inside = np.clip(asked, 0, 1)
    if outside.any():
        rows = asked[outside].astype(float)
        if way == "error":
            raise_out_of_gamut(rows)
        inside[outside] = np.clip(_moved(rows, gamut, way), 0, 1)  # rounding
    return GamutMapped(asked, inside, outside)


def check_method(way: str) -> None:
    """Raises `OptionError` for an unknown one."""
    if way not in METHODS:
        raise OptionError(f"unknown way out of gamut '{way}'", hint=f"use one of {', '.join(METHODS)}")


def as_rgb(rgb: ArrayLike) -> Values:
    """``rgb`` (…, 3) as float32, if that is what it is, or float64. Raises `ColourError` for other shapes."""
    single = isinstance(rgb, np.ndarray) and rgb.dtype == np.float32
    try:
        array: Values = np.asarray(rgb) if single else np.asarray(rgb, dtype=float)
    except (TypeError, ValueError) as error:
        raise ColourError("a colour is three numbers") from error
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ColourError(f"a colour is three numbers, not an array of shape {array.shape}")
    return array


def raise_out_of_gamut(outside: Array) -> NoReturn:
    """Raises `ColourError`, quoting the first of linear RGB (n, 3)."""
    raise ColourError(
        f"linear RGB {_quoted(outside[0])} lies outside [0, 1]",
        hint="reflectances reach no further; move it with --out-of-gamut, or use --8bit for codes",
    )


def _moved(rgb: Array, gamut: Gamut, way: str) -> Array:
    finite = np.isfinite(rgb).all(axis=1)
    if not finite.all():
        first = rgb[int(finite.argmin())]
        raise ColourError(f"linear RGB {_quoted(first)} is not finite", hint="mend what made it")
    rgb = rgb * np.minimum(1, LARGEST / np.abs(rgb).max(axis=1, keepdims=True))
    blocks = (rgb[first : first + BLOCK] for first in range(0, len(rgb), BLOCK))
    return np.concatenate([MAPPINGS[way](block, gamut) for block in blocks])


def _quoted(rgb: Array) -> str:
    return "(" + ", ".join(f"{value:g}" for value in rgb) + ")"
