"""Munsell chips outside sRGB, and the distance of colours from those of the hue of a chip.

The renotation (Newhall, Nickerson & Judd 1943) as in colour-science, without extrapolated chips. Observers judged its
hues and lightnesses equal, independently of the colour spaces of the gamut mappings.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import colour
import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.gamut import SRGB, Primaries, conversion
from uplift.common.arrays import Array

BRIGHTEST, DARKEST = 9, 2
"""Munsell values between which hues are well known."""
STEP = 0.25
"""Step of chroma along a line of constant hue and value."""
WHITE = SRGB.rgb_to_xyz.sum(axis=1)


@dataclass(frozen=True, eq=False)
class Chips:
    """Linear sRGB (n, 3) and hues (n,) of the chips outside; x, y (k, 2) by hue and value, from grey outwards."""

    rgb: Array
    hues: tuple[str, ...]
    lines: dict[tuple[str, float], Array]

    def hue_shift(self, mapped: Array) -> Array:
        """Return ΔE00 (n,) between mapped linear sRGB (n, 3) and the nearest colour of the hue at equal luminance."""
        light = (mapped @ SRGB.rgb_to_xyz.T)[:, 1]
        values = np.clip(colour.notation.munsell_value_ASTMD1535(100 * light), 1, 9)
        nearest = [
            delta_e_2000(_lab_of(self._line(hue, value), y), colour_lab).min()
            for hue, value, y, colour_lab in zip(self.hues, values, light, _lab(mapped), strict=True)
        ]
        return np.array(nearest)

    def _line(self, hue: str, value: float) -> Array:
        """Interpolate between the lines of the values below and above, at equal chroma."""
        low = min(int(value), 8)
        below, above = self.lines[hue, low], self.lines[hue, low + 1]
        count = min(len(below), len(above))
        return below[:count] + (value - low) * (above[:count] - below[:count])


def chips() -> Chips:
    """Return the chips outside sRGB; illuminant C is adapted to the white of the screen (Bradford)."""
    c = tuple(colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["C"])
    to_srgb = conversion(Primaries(SRGB.red, SRGB.green, SRGB.blue, c), SRGB)
    from_xyz = to_srgb @ np.linalg.inv(Primaries(SRGB.red, SRGB.green, SRGB.blue, c).rgb_to_xyz)
    real = {name for name, _ in colour.MUNSELL_COLOURS["Munsell Colours Real"]}
    book = colour.MUNSELL_COLOURS["Munsell Colours All"]  # lines extend beyond the real chips
    names = [name for name, _ in book]
    xyz = colour.xyY_to_XYZ(np.array([xyY for _, xyY in book]) / [1, 1, 100])
    rgb = xyz @ from_xyz.T
    outside = [
        row
        for row, name in enumerate(names)
        if name in real and DARKEST <= name[1] <= BRIGHTEST and ((rgb[row] < 0) | (rgb[row] > 1)).any()
    ]
    return Chips(rgb[outside], tuple(names[row][0] for row in outside), _lines(names, rgb @ SRGB.rgb_to_xyz.T))


def _lines(names: list[tuple[str, float, float]], xyz: Array) -> dict[tuple[str, float], Array]:
    found = defaultdict(list)
    for (hue, value, chroma), row in zip(names, xyz, strict=True):
        found[hue, value].append((chroma, *(row[:2] / row.sum())))
    lines = {}
    for key, points in found.items():
        chroma, x, y = np.array([(0.0, *SRGB.white), *sorted(points)]).T
        at = np.arange(0, chroma[-1] + STEP / 2, STEP)
        lines[key] = np.stack([np.interp(at, chroma, x), np.interp(at, chroma, y)], axis=1)
    return lines


def _lab_of(xy: Array, light: float) -> Array:
    x, y = xy.T
    return lab(np.stack([x, y, 1 - x - y], axis=1) * (light / y)[:, None], WHITE)


def _lab(rgb: Array) -> Array:
    return lab(rgb @ SRGB.rgb_to_xyz.T, WHITE)


def differences(chips: Chips, mapped: Array) -> tuple[Array, Array]:
    """Return ΔE00 (n,) and |ΔL*| (n,) between the chips and their mapped colours."""
    original, lab_mapped = _lab(chips.rgb), _lab(mapped)
    return delta_e_2000(original, lab_mapped), np.abs(original[:, 0] - lab_mapped[:, 0])
