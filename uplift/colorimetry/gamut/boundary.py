"""Display gamuts by primaries and white, and conversion between them.

Fishkin 1983, *Applying Color Science to Computer Graphics*, chapter 4: chromaticities of the primaries give the
columns of the matrix to XYZ up to their lengths, and the white gives the lengths.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
"""XYZ to the cone responses of Bradford adaptation (Lam 1985; the matrix of ICC.1:2022, annex E)."""

Chromaticity = tuple[float, float]
"""CIE x, y."""


class Gamut(Protocol):
    """An RGB space whose linear RGB in [0, 1] can be displayed.

    Both `Primaries` and `uplift.colorimetry.sensor.Sensor` fulfil this protocol.
    """

    @property
    def rgb_to_xyz(self) -> Array:
        """Matrix from linear RGB to XYZ; white, (1, 1, 1), has Y = 1. Shape (3, 3)."""
        ...


@dataclass(frozen=True)
class Primaries:
    """A display gamut by the chromaticities of its primaries and white.

    Parameters
    ----------
    red, green, blue : tuple of float
        CIE x, y of the primaries.
    white : tuple of float
        CIE x, y of the white, inside their triangle.

    Raises
    ------
    OptionError
        The primaries do not span a triangle with the white inside.
    """

    red: Chromaticity
    green: Chromaticity
    blue: Chromaticity
    white: Chromaticity

    def __post_init__(self) -> None:
        if not self._span_a_gamut():
            raise OptionError(
                f"primaries must span a triangle with the white inside, got ({self})",
                code="invalid-primaries",
                hint="give x,y of red, green, blue and white",
            )

    @classmethod
    def of(cls, numbers: Sequence[float]) -> Primaries:
        """Create primaries from eight numbers, in the order of OpenEXR headers.

        Parameters
        ----------
        numbers : sequence of float, length 8
            x, y of red, green, blue and white.

        Returns
        -------
        Primaries

        Raises
        ------
        OptionError
            There are not eight numbers, or they do not define a gamut.
        """
        if len(numbers) != 8:
            raise OptionError(
                f"primaries and white are eight numbers, got {len(numbers)}",
                code="invalid-primaries",
                hint="give x,y of red, green, blue and white",
            )
        pairs = [(float(x), float(y)) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
        return cls(*pairs)

    def __str__(self) -> str:
        return " ".join(f"{x:g},{y:g}" for x, y in (self.red, self.green, self.blue, self.white))

    @cached_property
    def rgb_to_xyz(self) -> Array:
        """Matrix from linear RGB to XYZ; white has Y = 1; shape (3, 3)."""
        return self._columns * self.lengths

    @cached_property
    def lengths(self) -> Array:
        """X + Y + Z of each primary at full power: ρ, γ and β of equation 4.5; shape (3,)."""
        x, y = self.white
        white = np.array([x, y, 1 - x - y]) / y if y else np.full(3, np.nan)
        return np.asarray(np.linalg.solve(self._columns, white))

    def _span_a_gamut(self) -> bool:
        with np.errstate(all="ignore"):
            if not abs(np.linalg.det(self._columns)) > 1e-6:  # False for NaN
                return False
            return bool(((self.lengths > 0) & np.isfinite(self.lengths)).all())

    @property
    def _columns(self) -> Array:
        return np.array([[x, y, 1 - x - y] for x, y in (self.red, self.green, self.blue)]).T


SRGB = Primaries((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))
"""The sRGB gamut (IEC 61966-2-1)."""


def conversion(source: Gamut, target: Gamut) -> Array:
    """Compute the matrix between the linear RGB of two gamuts, with Bradford adaptation of the white.

    Shape (3, 3).

    >>> import numpy as np
    >>> bool(np.allclose(conversion(SRGB, SRGB), np.eye(3)))
    True
    """
    before, after = (BRADFORD @ gamut.rgb_to_xyz.sum(axis=1) for gamut in (source, target))
    adapt = np.linalg.solve(BRADFORD, (after / before)[:, None] * BRADFORD)
    matrix = np.linalg.solve(target.rgb_to_xyz, adapt @ source.rgb_to_xyz)
    return np.asarray(matrix / matrix.sum(axis=1, keepdims=True))
