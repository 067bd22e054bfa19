"""Gamut mapping of Munsell chips outside sRGB, for docs/guides/acescg.md and its
picture.
"""

import warnings
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import colour
import numpy as np

from benchmarks import DOCS, Row, summary
from uplift.colorimetry import delta_e_2000, in_unit_cube, lab
from uplift.colorimetry.gamut import METHODS, SRGB, Primaries, conversion, map_to_gamut
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import picture
from uplift.extras.pages.panels import Panel, draw

DARKEST = 2
BRIGHTEST = 9
"""Munsell values between which hues are well known."""
STEP = 0.25
"""Step of chroma along a line of constant hue and value."""
WHITE = SRGB.rgb_to_xyz.sum(axis=1)
REC_2020 = Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
MAPPINGS = tuple(method for method in METHODS if method != "error")


@dataclass(frozen=True, eq=False)
class Chips:
    """Linear sRGB (n, 3) and hues (n,) of the chips outside.

    ``lines``: x, y (k, 2) by hue and value, from grey outwards.
    """

    rgb: Array
    hues: tuple[str, ...]
    lines: dict[tuple[str, int], Array]

    def line(self, hue: str, value: float) -> Array:
        """Interpolate between the lines of the values below and above, at equal
        chroma.
        """
        low = min(int(value), 8)
        below = self.lines[hue, low]
        above = self.lines[hue, low + 1]
        count = min(len(below), len(above))
        return below[:count] + (value - low) * (above[:count] - below[:count])

    def hue_shifts(self, mapped: Array) -> Array:
        """Return ΔE00 (n,) between mapped linear sRGB (n, 3) and the nearest colour of
        the hue at equal luminance.
        """
        luminance = (mapped @ SRGB.rgb_to_xyz.T)[:, 1]
        values = colour.notation.munsell_value_ASTMD1535(100 * luminance)
        shifts = []
        for hue, value, light, found in zip(
            self.hues, np.clip(values, 1, 9), luminance, rgb_to_lab(mapped), strict=True
        ):
            x, y = self.line(hue, value).T
            xyz = np.stack([x, y, 1 - x - y], axis=1) * (light / y)[:, None]
            shifts.append(delta_e_2000(lab(xyz, WHITE), found).min())
        return np.array(shifts)


def read_chips() -> Chips:
    """Return the chips outside sRGB; illuminant C is adapted to the white of the screen
    (Bradford).
    """
    c = tuple(colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["C"])
    under_c = Primaries(SRGB.red, SRGB.green, SRGB.blue, c)
    from_xyz = conversion(under_c, SRGB) @ np.linalg.inv(under_c.rgb_to_xyz)
    real = {name for name, _ in colour.MUNSELL_COLOURS["Munsell Colours Real"]}
    hues = []
    outside = []
    points = defaultdict(list)
    # Lines extend beyond the real chips.
    for name, (x, y, luminance) in colour.MUNSELL_COLOURS["Munsell Colours All"]:
        hue, value, chroma = name
        rgb = from_xyz @ colour.xyY_to_XYZ([x, y, luminance / 100])
        xyz = SRGB.rgb_to_xyz @ rgb
        points[hue, value].append((chroma, *(xyz[:2] / xyz.sum())))
        is_known = name in real and DARKEST <= value <= BRIGHTEST
        if is_known and not in_unit_cube(rgb):
            hues.append(hue)
            outside.append(rgb)
    lines = {key: resample_line(line) for key, line in points.items()}
    return Chips(np.array(outside), tuple(hues), lines)


def resample_line(points: list[tuple[float, float, float]]) -> Array:
    """Return x, y (k, 2) at even steps of chroma, from points of chroma, x and y."""
    chroma, *xy = np.array([(0.0, *SRGB.white), *sorted(points)]).T
    at = np.arange(0, chroma[-1] + STEP / 2, STEP)
    return np.stack([np.interp(at, chroma, axis) for axis in xy], axis=1)


def rgb_to_lab(rgb: Array) -> Array:
    """Return CIE L*a*b* of linear sRGB (n, 3)."""
    return lab(rgb @ SRGB.rgb_to_xyz.T, WHITE)


def shifts() -> Iterator[Row]:
    """Yield the hue shift, |ΔL*| and ΔE00 of mapped chips."""
    # colour-science warns about undefined values in some spaces.
    warnings.simplefilter("ignore")
    chips = read_chips()
    original = rgb_to_lab(chips.rgb)
    for method in MAPPINGS:
        mapped = map_to_gamut(chips.rgb, SRGB, method).rgb
        changed = rgb_to_lab(mapped)
        measures = {
            "hue": chips.hue_shifts(mapped),
            "lightness": np.abs(original[:, 0] - changed[:, 0]),
            "ΔE00": delta_e_2000(original, changed),
        }
        for measure, values in measures.items():
            yield {"method": method, "measure": measure, **summary(values)}


def draw_hues() -> None:
    """Draw the hues of Rec. 2020 as each method maps them, from dark to three times
    white.
    """
    hue = np.linspace(0, 6, 360)
    pure = np.clip(np.abs((hue[:, None] + [3, 1, 5]) % 6 - 3) - 1, 0, 1)
    brightness = np.geomspace(3, 0.02, 180)[:, None, None]
    image = (brightness * pure) @ conversion(REC_2020, SRGB).T
    panels = []
    for method in MAPPINGS:
        mapped = encode(map_to_gamut(image, SRGB, method).rgb)
        panels.append(Panel([picture(mapped, interpolation="antialiased")], method))
    figure = draw(panels, len(panels), 2.4)
    write_figure(figure, DOCS / "display" / "ways.png", force=True)


QUESTIONS = {"shifts": shifts, "picture": draw_hues}
