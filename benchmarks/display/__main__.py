"""What becomes of colours that no screen shows: ``make display`` → docs/display.md, docs/display/ways.png."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

from benchmarks.display.introduction import INTRODUCTION
from benchmarks.display.munsell import Chips, apart, chips
from benchmarks.display.picture import WAYS, draw
from benchmarks.display.spaces import ACESCG, SPACES, desaturated, hollow
from benchmarks.page import table, write
from benchmarks.timing import ROOT
from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.common.arrays import Array
from uplift.lab.timing import timed

PICTURES = ROOT / "docs" / "display"
TIMED = 1 << 16
"""Colours, all outside."""
RUNS = 7

FAMILIES = ("R", "YR", "Y", "GY", "G", "BG", "B", "PB", "P", "RP")
OFF_HUE = ["hue, mean", "95 %", "largest", "lightness, mean", "largest", "ΔE00, mean", "95 %"]


def main() -> None:
    warnings.simplefilter("ignore")  # of colours that spaces have no numbers for
    PICTURES.mkdir(exist_ok=True)
    draw(PICTURES / "ways.png")
    found = chips()
    print(write("display", INTRODUCTION, [_ways(found), _families(found), _spaces(found)]))


def _ways(found: Chips) -> str:
    rows = [[way, *_judged(found, map_to_gamut(found.rgb, SRGB, way).rgb), _cost(way)] for way in WAYS]
    words = (
        f"{len(found.hues):,} chips of the Munsell book that lie outside sRGB. *Hue*: ΔE00 from what is shown to the "
        "nearest colour that the renotation gives the chip's hue, as light as what is shown: what a way does to "
        "hue, as observers saw it. *Lightness*: |ΔL\\*| to the chip, *ΔE00*: to the chip; something must be given "
        "up, so that neither can be 0. *ns*: CPU time of a colour that is moved, one thread, median (least–most) of "
        f"{RUNS} runs over {TIMED:,}."
    )
    return table("What the ways keep", words, ["way", *OFF_HUE, "ns"], rows)


def _families(found: Chips) -> str:
    families = np.array([hue.lstrip("0123456789.") for hue in found.hues])
    off = {way: found.off_hue(map_to_gamut(found.rgb, SRGB, way).rgb) for way in WAYS}
    rows = [
        [name, str((families == name).sum()), *(f"{off[way][families == name].mean():.2f}" for way in WAYS)]
        for name in FAMILIES
    ]
    words = (
        "Mean *hue* of the table above, by the hues of the chips. Oklab's lines follow reds, yellows and "
        "blue-greens; in blues, where they lead to teal, the dominant wavelength is nearer to what observers saw."
    )
    return table("By hue", words, ["hue", "chips", *WAYS], rows)


def _spaces(found: Chips) -> str:
    rows = [
        [
            space.name,
            *_judged(found, desaturated(space, found.rgb)),
            f"{hollow(space, SRGB):.4f}",
            f"{hollow(space, ACESCG):.4f}",
        ]
        for space in SPACES
    ]
    words = (
        "The same chips at constant lightness and hue of several spaces, as colour-science has them. *Hollow*: how "
        "far, in linear RGB, straight lines from grey to the surface of a gamut leave it on the way. Where they do, "
        "colours that are hardly apart end far apart, and textures tear. CIELUV has none, being lines of one dominant "
        "wavelength: `desaturate`. Of the others, much alike for hue but for CAM16-UCS, Oklab has the shallowest, and "
        "needs no more than two matrices and cubes."
    )
    return table("Which space", words, ["space", *OFF_HUE, "hollow of sRGB", "of ACEScg"], rows)


def _judged(found: Chips, shown: Array) -> list[str]:
    off = found.off_hue(shown)
    difference, lightness = apart(found, shown)
    numbers: list[tuple[Callable[[Array], float], Array]] = [
        (np.mean, off),
        (_most, off),
        (np.max, off),
        (np.mean, lightness),
        (np.max, lightness),
        (np.mean, difference),
        (_most, difference),
    ]
    return [f"{function(values):.2f}" for function, values in numbers]


def _most(values: Array) -> float:
    return float(np.percentile(values, 95))


def _cost(way: str) -> str:
    rgb = np.random.default_rng(0).normal(0.5, 1, (3 * TIMED, 3))
    rgb = rgb[((rgb < 0) | (rgb > 1)).any(axis=1)][:TIMED]
    map_to_gamut(rgb, SRGB, way)
    _, cpu = timed(lambda: map_to_gamut(rgb, SRGB, way), RUNS)
    return f"{cpu.scaled(1e9 / TIMED):.0f}"


if __name__ == "__main__":
    main()
