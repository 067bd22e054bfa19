"""Ramps of the mixing models, and coats of increasing thickness, as PNG."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.mixing.paints import published
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.design.mixing import Ingredients, Medium, dispersive, make_coat, mixers, ramp
from uplift.lookup import Cube
from uplift.viz.plots import Strip, plot_strips

STEPS = 11
PAIRS = {
    "blue-yellow": ("#005fa0", "#ffd200"),
    "atlas-blue-yellow": ("blue", "yellow"),
    "red-white": ("#b01030", "#ffffff"),
    "red-green": ("#d02020", "#20a040"),
}
"""Names of entries, or codes."""
DRAWN = (
    "pigments",
    "pigments in oil",
    "pigments, S = √R",
    "pigments, S = 1",
    "dyes",
    "average",
    "ryb",
    "phosphors",
    "product",
)
"""Shares are the thickness of filters and products, so that a ramp ends at its colours."""


def draw(cube: Cube, smooth: Cube, folder: Path) -> None:
    """Write a picture for each pair of colours, one of coats, and one that compares other tools, by ``smooth``."""
    folder.mkdir(exist_ok=True)
    for name, pair in PAIRS.items():
        rgb = np.array([colour(cube, word) for word in pair])
        plot_strips(_ramps(cube, rgb), folder / f"{name}.png", force=True)
    plot_strips(_coats(cube), folder / "thickness.png", force=True)
    plot_strips(_tools(smooth), folder / "tools.png", force=True)


def colour(cube: Cube, word: str) -> Array:
    """Return the linear RGB (3,) of an entry or of '#rrggbb'."""
    if word.startswith("#"):
        return cube.decode([int(word[i : i + 2], 16) for i in (1, 3, 5)])
    return np.asarray(cube.data.atlas.rgb[cube.data.atlas.names.index(word)], dtype=float)


def _ramps(cube: Cube, rgb: Array) -> list[Strip]:
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    parts = ramp(np.ones(2), STEPS)
    return [_strip(cube, by_name[name].title, by_name[name].mix(rgb, parts)) for name in DRAWN]


def _tools(cube: Cube) -> list[Strip]:
    """Return the ramp of two artists' paints by RGB, by us before and now, and as other tools publish it."""
    steps = published("coloraide", cube)
    ends = steps.paints[:2]
    parts = np.concatenate([[[1, 0]], steps.shares, [[0, 1]]])
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    mixbox = published("mixbox", cube).expected[:1]
    encoded = np.clip(cube.decode(parts @ cube.encode(ends)), 0, 1)
    ramps = {
        "mean of sRGB codes": encoded,
        "uplift mix --scattering root, the default before": by_name["pigments, S = √R"].mix(ends, parts),
        "uplift mix, the default now": by_name["pigments"].mix(ends, parts),
        "coloraide's spectral, after spectral.js (published)": np.concatenate([ends[:1], steps.expected, ends[1:]]),
        "Mixbox 1:1 (published)": np.concatenate([ends[:1], mixbox, ends[1:]]),
    }
    return [_strip(cube, title, rgb) for title, rgb in ramps.items()]


def _coats(cube: Cube) -> list[Strip]:
    """Return strips of paints on white and on black and of dyes, with doubling thickness."""
    thickness = [0, *(2.0 ** np.arange(-4, 3))]
    spectra = cube.reflectance(np.array([colour(cube, word) for word in ("#b01030", "#ffd200", "#005fa0")]))
    strips = []
    for name, spectrum in zip(("red", "yellow", "blue"), spectra, strict=True):
        colorant, scattering = Ingredients(spectrum[None]), dispersive(cube.data.sensor)
        for ground, on in ((1.0, "white"), (0.0, "black")):
            media = [Medium(x, scattering=scattering) for x in thickness]
            layers = [make_coat("pigment", colorant, [1], medium).over(np.full(81, ground)) for medium in media]
            title = f"{name} paint on {on}, {', '.join(f'{x:.3g}' for x in thickness)} units thick"
            strips.append(_strip(cube, title, cube.data.sensor.rgb(layers)))
        layers = [make_coat("dye", colorant, [1], Medium(x)).over(1.0) for x in thickness]
        strips.append(_strip(cube, f"{name} dye on white, the same thicknesses", cube.data.sensor.rgb(layers)))
    return strips


def _strip(cube: Cube, title: str, rgb: Array) -> Strip:
    return Strip(title, to_display_codes(rgb, cube.data.sensor) / 255)
