"""Gamut mapping of Munsell chips outside sRGB, for docs/guides/acescg.md and its
picture.
"""

import warnings
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import colour
import numpy as np

from benchmarks import DOCS, Row, record
from uplift.colorimetry import delta_e_2000, lab
from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, conversion, map_to_gamut
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.extras.pages.figure import new_figure, write_png
from uplift.lab.timing import TimingStats, time_laps

BRIGHTEST, DARKEST = 9, 2
"""Munsell values between which hues are well known."""
STEP = 0.25
"""Step of chroma along a line of constant hue and value."""
WHITE = SRGB.rgb_to_xyz.sum(axis=1)


@dataclass(frozen=True, eq=False)
class Chips:
    """Linear sRGB (n, 3) and hues (n,) of the chips outside; x, y (k, 2) by hue and
    value, from grey outwards.
    """

    rgb: Array
    hues: tuple[str, ...]
    lines: dict[tuple[str, float], Array]

    def hue_shift(self, mapped: Array) -> Array:
        """Return ΔE00 (n,) between mapped linear sRGB (n, 3) and the nearest colour of
        the hue at equal luminance.
        """
        light = (mapped @ SRGB.rgb_to_xyz.T)[:, 1]
        values = np.clip(colour.notation.munsell_value_ASTMD1535(100 * light), 1, 9)
        nearest = [
            delta_e_2000(_lab_of(self._line(hue, value), y), colour_lab).min()
            for hue, value, y, colour_lab in zip(
                self.hues, values, light, _lab(mapped), strict=True
            )
        ]
        return np.array(nearest)

    def _line(self, hue: str, value: float) -> Array:
        """Interpolate between the lines of the values below and above, at
        equal chroma.
        """
        low = min(int(value), 8)
        below = self.lines[hue, low]
        above = self.lines[hue, low + 1]
        count = min(len(below), len(above))
        return below[:count] + (value - low) * (above[:count] - below[:count])


def chips() -> Chips:
    """Return the chips outside sRGB; illuminant C is adapted to the white of the screen
    (Bradford).
    """
    c = tuple(colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["C"])
    to_srgb = conversion(Primaries(SRGB.red, SRGB.green, SRGB.blue, c), SRGB)
    from_xyz = to_srgb @ np.linalg.inv(
        Primaries(SRGB.red, SRGB.green, SRGB.blue, c).rgb_to_xyz
    )
    real = {name for name, _ in colour.MUNSELL_COLOURS["Munsell Colours Real"]}
    book = colour.MUNSELL_COLOURS[
        "Munsell Colours All"
    ]  # lines extend beyond the real chips
    names = [name for name, _ in book]
    xyz = colour.xyY_to_XYZ(np.array([xyY for _, xyY in book]) / [1, 1, 100])
    rgb = xyz @ from_xyz.T
    outside = [
        row
        for row, name in enumerate(names)
        if name in real
        and DARKEST <= name[1] <= BRIGHTEST
        and ((rgb[row] < 0) | (rgb[row] > 1)).any()
    ]
    return Chips(
        rgb[outside],
        tuple(names[row][0] for row in outside),
        _lines(names, rgb @ SRGB.rgb_to_xyz.T),
    )


def _lines(
    names: list[tuple[str, float, float]], xyz: Array
) -> dict[tuple[str, float], Array]:
    found = defaultdict(list)
    for (hue, value, chroma), row in zip(names, xyz, strict=True):
        found[hue, value].append((chroma, *(row[:2] / row.sum())))
    lines = {}
    for key, points in found.items():
        chroma, x, y = np.array([(0.0, *SRGB.white), *sorted(points)]).T
        at = np.arange(0, chroma[-1] + STEP / 2, STEP)
        lines[key] = np.stack(
            [np.interp(at, chroma, x), np.interp(at, chroma, y)], axis=1
        )
    return lines


def _lab_of(xy: Array, light: float) -> Array:
    x, y = xy.T
    return lab(np.stack([x, y, 1 - x - y], axis=1) * (light / y)[:, None], WHITE)


def _lab(rgb: Array) -> Array:
    return lab(rgb @ SRGB.rgb_to_xyz.T, WHITE)


REC_2020 = Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
MAPPINGS = tuple(method for method in METHODS if method != "error")


def draw(path: Path) -> None:
    """Write the picture: the hues of Rec. 2020 as each method maps them, dark below, up
    to three times white above.
    """
    figure = new_figure(15, 2.25)
    hue = np.linspace(0, 6, 360)
    pure = np.clip(np.abs((hue[:, None] + [3, 1, 5]) % 6 - 3) - 1, 0, 1)
    image = (np.geomspace(3, 0.02, 180)[:, None, None] * pure) @ conversion(
        REC_2020, SRGB
    ).T
    for axes, method in zip(figure.subplots(1, len(MAPPINGS)), MAPPINGS, strict=True):
        axes.imshow(
            encode(map_to_gamut(image, SRGB, method).rgb), interpolation="antialiased"
        )
        axes.set_title(method, fontsize=17, pad=8)
        axes.set_axis_off()
    write_png(figure, path, force=True)


PICTURE = DOCS / "display" / "ways.png"
TIMED = 1 << 16
"""Colours, all of them outside."""
LAP = 0.02
RUNS = 7


def main() -> None:
    """Draw, measure and store."""
    warnings.simplefilter(
        "ignore"
    )  # colour-science warns about undefined values in some spaces
    draw(PICTURE)
    found = chips()
    mapped = {name: map_to_gamut(found.rgb, SRGB, name).rgb for name in MAPPINGS}
    record(
        "display",
        chips=len(found.hues),
        methods=[
            {"name": name, **errors(found, rgb), "ns": cost(name)}
            for name, rgb in mapped.items()
        ],
    )


def errors(found: Chips, mapped: Array) -> Row:
    """Return statistics of the hue shift, |ΔL*| and ΔE00 of mapped colours."""
    original = _lab(found.rgb)
    changed = _lab(mapped)
    values = {
        "hue": found.hue_shift(mapped),
        "lightness": np.abs(original[:, 0] - changed[:, 0]),
        "delta_e": delta_e_2000(original, changed),
    }
    return {
        name: {
            "mean": each.mean(),
            "p95": np.percentile(each, 95),
            "largest": each.max(),
        }
        for name, each in values.items()
    }


def cost(method: str) -> TimingStats:
    """Return the CPU time per mapped colour in nanoseconds."""
    rgb = np.random.default_rng(0).normal(0.5, 1, (3 * TIMED, 3))
    rgb = rgb[((rgb < 0) | (rgb > 1)).any(axis=1)][:TIMED]
    return time_laps(lambda: map_to_gamut(rgb, SRGB, method), LAP, RUNS).scaled(
        1e9 / TIMED
    )
