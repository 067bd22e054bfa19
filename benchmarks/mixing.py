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
    mean_of_codes,
    mixture_sets,
    ramp_between,
)
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.paint.optics import average_areas
from uplift.extras.paint.pigments import CONSTANT, SQUARE_ROOT, dispersive
from uplift.extras.paint.rgb_mixer import make_mixer
from uplift.extras.paint.theories import mixers
from uplift.lookup.cube import Cube

ARTISTS = ("#002185", "#fcd200")
"""Cobalt blue and Hansa yellow, as Mixbox's table has them."""
BLUE_YELLOW = ("#005fa0", "#ffd200")
DEFAULT = "Y^¾ exp(h / 4)"
"""Rule of ``uplift paints mix``."""
STEPS = 11
DRAWN = (
    "Kubelka–Munk", "Kubelka–Munk, in oil (index 1.5)", "Kubelka–Munk, S = √R",
    "Kubelka–Munk, S = 1", "dyes on white", "average of RGB", "RYB-HSL",
    "phosphor curves", "product of RGB",
)  # fmt: skip


def ways(cube: Cube) -> dict[str, MixRgb]:
    """Return the ways of mixing RGB by title."""
    best = dispersive(cube.data.sensor)
    rules = {
        "1": CONSTANT,
        "R^½": SQUARE_ROOT,
        "R^¾": lambda R: R**0.75,
        "R^0.9": lambda R: R**0.9,
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
    codes = {}
    for way, mix in ways(uplift.load()).items():
        _, green, _ = ramp_between(*ARTISTS, mix, 3)
        (codes[way],) = hex_codes(np.clip([green], 0, 1))
    return codes


def pictures() -> None:
    """Draw ramps from blue to yellow by theories."""
    # Parts are the thickness of filters and products, so that a ramp ends at its
    # colours.
    ramps = {
        title: ramp_between(*BLUE_YELLOW, mix, STEPS)
        for title, mix in mixers(uplift.load()).items()
        if title in DRAWN
    }
    draw_ramps(ramps, DOCS / "mixing" / "blue-yellow.png")


QUESTIONS = {"mixtures": mixtures, "greens": greens, "pictures": pictures}
