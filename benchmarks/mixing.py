"""Mixtures of known paints from the RGB of both, by rules for S, means of RGB and the
exported mixer, and ramps, for docs/mixing.md and docs/guides/mixer.md.
"""

from dataclasses import replace

import numpy as np

import uplift
from benchmarks import DOCS, Row, summary
from benchmarks.mixtures import (
    MixRgb,
    by_spectra,
    draw_ramps,
    linear,
    mean_of_codes,
    mixture_sets,
    published,
)
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.paint import dispersive
from uplift.extras.paint.coats import ramp
from uplift.extras.paint.optics import average_areas
from uplift.extras.paint.pigments import CONSTANT, SQUARE_ROOT, PowerOfReflectance
from uplift.extras.paint.rgb_mixer import make_mixer
from uplift.extras.paint.theories import mixers
from uplift.lookup import Cube

ARTISTS = ("#002185", "#fcd200")
"""Cobalt blue and Hansa yellow, as Mixbox's table has them."""
BLUE_YELLOW = ("#005fa0", "#ffd200")
DEFAULT = "Y^¾ exp(h / 4)"
"""Rule of ``uplift mix``."""
STEPS = 11
DRAWN = (
    "pigments", "pigments in oil", "pigments, S = √R", "pigments, S = 1", "dyes",
    "average", "ryb", "phosphors", "product",
)  # fmt: skip


def ways(cube: Cube) -> dict[str, MixRgb]:
    """Return the ways of mixing RGB by title."""
    best = dispersive(cube.data.sensor)
    rules = {
        "1": CONSTANT,
        "R^½": SQUARE_ROOT,
        "R^¾": PowerOfReflectance(0.75),
        "R^0.9": PowerOfReflectance(0.9),
        "Y^½": replace(best, exponent=0.5, weight=0.0),
        "Y^¾": replace(best, weight=0.0),
        "Y": replace(best, exponent=1.0, weight=0.0),
        "Y^½ exp(h / 4)": replace(best, exponent=0.5),
        DEFAULT: best,
        "Y exp(h / 4)": replace(best, exponent=1.0),
    }
    return {
        "mean of linear RGB": average_areas,
        "mean of sRGB codes": mean_of_codes,
        "exported mixer": make_mixer(cube).mix_all,
        **{title: by_spectra(cube, rule) for title, rule in rules.items()},
    }


def mixtures() -> list[Row]:
    """Return the errors of each way by set."""
    cube = uplift.load()
    sets = mixture_sets()
    rows = []
    for way, mix in ways(cube).items():
        for name, known in sets.items():
            errors = known.errors(mix, cube.data.sensor)
            rows.append({"way": way, "set": name, **summary(errors)})
    return rows


def greens() -> dict[str, str]:
    """Return the codes of cobalt blue and Hansa yellow 1:1 by each way."""
    cube = uplift.load()
    paints = linear(*ARTISTS)[None]
    equal = np.full((1, 2), 0.5)
    codes = {}
    for way, mix in ways(cube).items():
        green = np.clip(mix(paints, equal), 0, 1)
        (codes[way],) = hex_codes(green, cube.data.sensor)
    return codes


def pictures() -> None:
    """Draw ramps from blue to yellow by theories, and by other tools."""
    cube = uplift.load()
    theories = {theory.name: theory for theory in mixers(cube)}
    paints = linear(*BLUE_YELLOW)
    # Parts are the thickness of filters and products, so that a ramp ends at its
    # colours.
    parts = ramp(np.ones(2), STEPS)
    drawn = [theories[name] for name in DRAWN]
    ramps = {theory.title: theory.mix(paints, parts) for theory in drawn}
    draw_ramps(ramps, DOCS / "mixing" / "blue-yellow.png")
    draw_ramps(tools(cube), DOCS / "mixing" / "tools.png")


def tools(cube: Cube) -> dict[str, Array]:
    """Return the ramp of two artists' paints by RGB, by us, and by other tools."""
    steps = published("coloraide")
    mixbox = published("mixbox").expected[:1]
    ends = steps.paints[:2]
    shares = np.concatenate([[[1, 0]], steps.shares, [[0, 1]]])
    colours = np.broadcast_to(ends, (len(shares), 2, 3))
    root = by_spectra(cube, SQUARE_ROOT)
    best = by_spectra(cube, dispersive(cube.data.sensor))
    return {
        "mean of sRGB codes": mean_of_codes(colours, shares),
        "uplift mix --scattering root": root(colours, shares),
        "uplift mix": best(colours, shares),
        "coloraide's spectral, after spectral.js (published)": np.concatenate(
            [ends[:1], steps.expected, ends[1:]]
        ),
        "Mixbox 1:1 (published)": np.concatenate([ends[:1], mixbox, ends[1:]]),
    }


QUESTIONS = {"mixtures": mixtures, "greens": greens, "pictures": pictures}
