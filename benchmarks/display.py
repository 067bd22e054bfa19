"""Gamut mapping of Munsell chips outside sRGB, for docs/guides/acescg.md and its
picture.
"""

import warnings
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import colour
import numpy as np

from benchmarks import DOCS, Row, record
from uplift.colorimetry import delta_e_2000, lab
from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, conversion, map_to_gamut
from uplift.common.arrays import Array, Mask
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.figure import new_figure, write_png
from uplift.lab.timing import TimingStats, time_laps

DARKEST = 2
BRIGHTEST = 9
"""Munsell values between which hues are well known."""
STEP = 0.25
"""Step of chroma along a line of constant hue and value."""
WHITE = SRGB.rgb_to_xyz.sum(axis=1)
Lines = dict[tuple[str, float], Array]


@dataclass(frozen=True, eq=False)
class Chips:
    """Linear sRGB (n, 3) and hues (n,) of the chips outside.

    ``lines``: x, y (k, 2) by hue and value, from grey outwards.
    """

    rgb: Array
    hues: tuple[str, ...]
    lines: Lines

    def hue_shift(self, mapped: Array) -> Array:
        """Return ΔE00 (n,) between mapped linear sRGB (n, 3) and the nearest colour of
        the hue at equal luminance.
        """
        light = (mapped @ SRGB.rgb_to_xyz.T)[:, 1]
        values = np.clip(colour.notation.munsell_value_ASTMD1535(100 * light), 1, 9)
        lines = map(self._line, self.hues, values)
        differences = map(delta_e_2000, map(_lab_of, lines, light), _lab(mapped))
        return np.array([difference.min() for difference in differences])

    def _line(self, hue: str, value: float) -> Array:
        """Interpolate between the lines of the values below and above."""
        low = min(int(value), 8)
        below = self.lines[hue, low]
        above = self.lines[hue, low + 1]
        count = min(len(below), len(above))  # at equal chroma
        return below[:count] + (value - low) * (above[:count] - below[:count])


def chips() -> Chips:
    """Return the chips outside sRGB; illuminant C is adapted to the white of the screen
    (Bradford).
    """
    c = tuple(colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["C"])
    under_c = Primaries(SRGB.red, SRGB.green, SRGB.blue, c)
    from_xyz = conversion(under_c, SRGB) @ np.linalg.inv(under_c.rgb_to_xyz)
    real = {name for name, _ in colour.MUNSELL_COLOURS["Munsell Colours Real"]}
    # Lines extend beyond the real chips.
    names, xyy = zip(*colour.MUNSELL_COLOURS["Munsell Colours All"], strict=True)
    rgb = colour.xyY_to_XYZ(np.array(xyy) / [1, 1, 100]) @ from_xyz.T
    is_outside = _is_outside(rgb)
    outside = [
        row
        for row, name in enumerate(names)
        if name in real and DARKEST <= name[1] <= BRIGHTEST and is_outside[row]
    ]
    hues = tuple(names[row][0] for row in outside)
    return Chips(rgb[outside], hues, _lines(names, rgb @ SRGB.rgb_to_xyz.T))


def _is_outside(rgb: Array) -> Mask:
    return ((rgb < 0) | (rgb > 1)).any(axis=1)


def _lines(names: Iterable[tuple[str, float, float]], xyz: Array) -> Lines:
    points = defaultdict(list)
    for (hue, value, chroma), row in zip(names, xyz, strict=True):
        points[hue, value].append((chroma, *(row[:2] / row.sum())))
    lines = {}
    for key, line in points.items():
        chroma, *xy = np.array([(0.0, *SRGB.white), *sorted(line)]).T
        at = np.arange(0, chroma[-1] + STEP / 2, STEP)
        lines[key] = np.stack([np.interp(at, chroma, axis) for axis in xy], axis=1)
    return lines


def _lab_of(xy: Array, light: float) -> Array:
    x, y = xy.T
    return lab(np.stack([x, y, 1 - x - y], axis=1) * (light / y)[:, None], WHITE)


def _lab(rgb: Array) -> Array:
    return lab(rgb @ SRGB.rgb_to_xyz.T, WHITE)


REC_2020 = Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
MAPPINGS = tuple(method for method in METHODS if method != "error")


def draw(path: Path) -> None:
    """Write the hues of Rec. 2020 as each method maps them, from dark to three times
    white.
    """
    figure = new_figure(15, 2.25)
    hue = np.linspace(0, 6, 360)
    pure = np.clip(np.abs((hue[:, None] + [3, 1, 5]) % 6 - 3) - 1, 0, 1)
    brightness = np.geomspace(3, 0.02, 180)[:, None, None]
    image = (brightness * pure) @ conversion(REC_2020, SRGB).T
    for axes, method in zip(figure.subplots(1, len(MAPPINGS)), MAPPINGS, strict=True):
        mapped = map_to_gamut(image, SRGB, method).rgb
        axes.imshow(encode(mapped), interpolation="antialiased")
        axes.set_title(method, fontsize=17, pad=8)
        axes.set_axis_off()
    write_png(figure, path, force=True)


TIMED = 1 << 16
"""Colours, all of them outside."""
LAP = 0.02
RUNS = 7


def main() -> None:
    """Draw, measure and store."""
    # colour-science warns about undefined values in some spaces.
    warnings.simplefilter("ignore")
    draw(DOCS / "display" / "ways.png")
    outside = chips()
    record(
        "display",
        chips=len(outside.hues),
        methods=[
            {"name": name, **errors(outside, name), "ns": cost(name)}
            for name in MAPPINGS
        ],
    )


def errors(outside: Chips, method: str) -> Row:
    """Return statistics of the hue shift, |ΔL*| and ΔE00 of mapped colours."""
    mapped = map_to_gamut(outside.rgb, SRGB, method).rgb
    original = _lab(outside.rgb)
    changed = _lab(mapped)
    values = {
        "hue": outside.hue_shift(mapped),
        "lightness": np.abs(original[:, 0] - changed[:, 0]),
        "delta_e": delta_e_2000(original, changed),
    }
    return {
        name: {
            "mean": shifts.mean(),
            "p95": np.percentile(shifts, 95),
            "largest": shifts.max(),
        }
        for name, shifts in values.items()
    }


def cost(method: str) -> TimingStats:
    """Return the CPU time per mapped colour in nanoseconds."""
    rgb = np.random.default_rng(0).normal(0.5, 1, (3 * TIMED, 3))
    rgb = rgb[_is_outside(rgb)][:TIMED]
    call = partial(map_to_gamut, rgb, SRGB, method)
    return time_laps(call, LAP, RUNS).scaled(1e9 / TIMED)
