"""What a display can show: RGB by primaries and white, and from one display to another. numpy alone.

Fishkin, *Applying Color Science to Computer Graphics* (1983), chapter 4: chromaticities of the primaries give the
columns of the matrix to XYZ but for their lengths, and the white gives these.
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
"""XYZ to the responses that adapt to a white (Lam 1985; the matrix of ICC.1:2022, annex E)."""

Chromaticity = tuple[float, float]
"""CIE x, y."""


class Gamut(Protocol):
    """Linear RGB, of which [0, 1] can be shown: a `Primaries`, or a cube's `uplift.colorimetry.sensor.Sensor`."""

    @property
    def rgb_to_xyz(self) -> Array:
        """(3, 3) linear RGB to XYZ; white, (1, 1, 1), has Y = 1."""
        ...


@dataclass(frozen=True)
class Primaries:
    """A display by the chromaticities of red, green and blue at their fullest, and of all three together.

    Raises `OptionError` where red, green and blue do not span a triangle with the white inside.
    """

    red: Chromaticity
    green: Chromaticity
    blue: Chromaticity
    white: Chromaticity

    def __post_init__(self) -> None:
        columns = self._columns
        with np.errstate(all="ignore"):
            spans = abs(np.linalg.det(columns)) > 1e-6  # NaN is not
        if not spans or not np.isfinite(columns).all() or not (self.lengths > 0).all():
            raise OptionError(
                f"({self}) are the primaries and white of no display",
                hint="name x,y of red, green, blue and white: the white lies within the triangle of the others",
            )

    @classmethod
    def of(cls, numbers: Sequence[float]) -> Primaries:
        """From x, y of red, green, blue and white, as headers of OpenEXR have them. Raises `OptionError`."""
        if len(numbers) != 8:
            raise OptionError(
                f"primaries and white are eight numbers, not {len(numbers)}",
                hint="name x,y of red, green, blue and white",
            )
        pairs = [(float(x), float(y)) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
        return cls(*pairs)

    def __str__(self) -> str:
        return " ".join(f"{x:g},{y:g}" for x, y in (self.red, self.green, self.blue, self.white))

    @cached_property
    def rgb_to_xyz(self) -> Array:
        """(3, 3) linear RGB to XYZ; white has Y = 1."""
        return self._columns * self.lengths

    @cached_property
    def lengths(self) -> Array:
        """(3,) X + Y + Z of each primary at its fullest: ρ, γ and β of equation 4.5."""
        x, y = self.white
        white = np.array([x, y, 1 - x - y]) / y if y else np.full(3, np.nan)
        return np.asarray(np.linalg.solve(self._columns, white))

    @property
    def _columns(self) -> Array:
        return np.array([[x, y, 1 - x - y] for x, y in (self.red, self.green, self.blue)]).T


SRGB = Primaries((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))
"""What screens are taken for (IEC 61966-2-1)."""


def conversion(source: Gamut, target: Gamut) -> Array:
    """(3, 3) linear RGB of one display to that of another: white stays white, by Bradford adaptation."""
    before, after = (BRADFORD @ gamut.rgb_to_xyz.sum(axis=1) for gamut in (source, target))
    adapt = np.linalg.solve(BRADFORD, (after / before)[:, None] * BRADFORD)
    matrix = np.linalg.solve(target.rgb_to_xyz, adapt @ source.rgb_to_xyz)
    return np.asarray(matrix / matrix.sum(axis=1, keepdims=True))
