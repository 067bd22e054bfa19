"""Apply a gamut mapping to arrays of colours and report the colours that it moved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut.boundary import Gamut
from uplift.colorimetry.gamut.mapping import MAPPINGS
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import ColourError, OptionError

METHODS = ("error", *MAPPINGS)
"""Names of the methods; ``"error"`` raises instead of moving a colour."""
BLOCK = 1 << 13
"""Colours mapped per block; the temporary arrays of a block fit into a processor's cache."""


@dataclass(frozen=True, eq=False)
class GamutMapped:
    """Linear RGB before and after gamut mapping.

    Parameters
    ----------
    requested : ndarray, shape (..., 3)
        Linear RGB before the mapping.
    rgb : ndarray, shape (..., 3)
        Linear RGB after it, in [0, 1].
    outside : ndarray of bool, shape (...)
        Colours that were outside [0, 1].
    """

    requested: Values
    rgb: Values
    outside: Mask

    @property
    def count(self) -> int:
        """Number of colours that were moved.

        Returns
        -------
        int
        """
        return int(self.outside.sum())

    @property
    def max_change(self) -> float:
        """Largest absolute change of a component.

        Returns
        -------
        float
        """
        return float(np.abs(self.requested[self.outside] - self.rgb[self.outside]).max(initial=0))


def map_to_gamut(rgb: ArrayLike, gamut: Gamut, method: str = "error") -> GamutMapped:
    """Move linear RGB outside [0, 1] inside; in-gamut colours are unchanged, bit for bit.

    Parameters
    ----------
    rgb : array_like, shape (..., 3)
        Linear RGB. float32 stays float32. Deviations by rounding (`uplift.colorimetry.sensor.SLACK`) are in gamut.
    gamut : Gamut
        The RGB space of ``rgb``: a cube's sensor, `Primaries`, or `SRGB`.
    method : str
        One of `METHODS`.

    Returns
    -------
    GamutMapped
        The colours before and after, and which of them were moved.

    Raises
    ------
    ColourError
        A colour that needs mapping is not finite, or lies outside [0, 1] and ``method`` is ``"error"``.
    OptionError
        The method is unknown.

    Examples
    --------
    >>> from uplift.colorimetry.gamut import SRGB
    >>> map_to_gamut([[0.2, 0.4, 0.6], [1.4, 0.2, -0.1]], SRGB, "clip").rgb.tolist()
    [[0.2, 0.4, 0.6], [1.0, 0.2, 0.0]]
    """
    check_method(method)
    requested = as_rgb(rgb)
    outside = ~in_unit_cube(requested)
    inside = np.clip(requested, 0, 1)
    if outside.any():
        rows = requested[outside].astype(float)
        if method == "error":
            raise_out_of_gamut(rows)
        inside[outside] = np.clip(_map_rows(rows, gamut, method), 0, 1)  # removes rounding errors
    return GamutMapped(requested, inside, outside)


def check_method(method: str) -> None:
    """Validate the name of a gamut mapping method."""
    if method not in METHODS:
        raise OptionError(
            f"unknown gamut mapping '{method}'", code="unknown-gamut-mapping", hint=f"use one of {', '.join(METHODS)}"
        )


def as_rgb(rgb: ArrayLike) -> Values:
    """Convert to an array of RGB triples. Shapes: ``rgb`` (…, 3) → (…, 3)."""
    is_single = isinstance(rgb, np.ndarray) and rgb.dtype == np.float32
    try:
        array: Values = np.asarray(rgb) if is_single else np.asarray(rgb, dtype=float)
    except (TypeError, ValueError) as error:
        raise ColourError("a colour is three numbers", code="rgb-not-numeric") from error
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ColourError(f"a colour is three numbers, got an array of shape {array.shape}", code="rgb-wrong-shape")
    return array


def raise_out_of_gamut(outside: Array) -> NoReturn:
    """Raise the error for colours outside [0, 1]. Shapes: ``outside`` (n, 3)."""
    raise ColourError(
        f"linear RGB {_format_rgb(outside[0])} lies outside [0, 1]",
        code="rgb-out-of-gamut",
        hint="map it with uplift.colorimetry.gamut.map_to_gamut, or convert 8-bit codes with Cube.decode",
    )


def _map_rows(rgb: Array, gamut: Gamut, method: str) -> Array:
    finite = np.isfinite(rgb).all(axis=1)
    if not finite.all():
        first = rgb[int(finite.argmin())]
        raise ColourError(
            f"linear RGB {_format_rgb(first)} is not finite", code="rgb-not-finite", hint="fix its source"
        )
    blocks = (rgb[first : first + BLOCK] for first in range(0, len(rgb), BLOCK))
    return np.concatenate([MAPPINGS[method](block, gamut) for block in blocks])


def _format_rgb(rgb: Array) -> str:
    return "(" + ", ".join(f"{value:g}" for value in rgb) + ")"
