"""Materials that `uplift advise` chooses to measure, against random choice, for
docs/guides/measuring.md.
"""

from collections.abc import Iterator
from functools import partial
from itertools import product

import numpy as np

import uplift
from benchmarks import Row
from benchmarks.materials import Materials, inside, spectra
from uplift.colorimetry import observer
from uplift.common.arrays import Indices
from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
from uplift.extras.report.comparison import delta_e_under
from uplift.extras.scene.advice import advise, uncertainty
from uplift.extras.texture.scene_colours import ColourSet, PixelSample
from uplift.lab.look_alikes import families_like

SETS = ("rawtoaces", "cie2017")
SCENES = 6
"""Scenes of each set."""
KNOWN = 10
"""Entries that are known at first."""
MATERIALS = 60
"""Largest number of hidden entries in a scene."""
COUNTS = (0, 3, 6, 12, 24)
DRAWS = 2
"""Random choices of each kind."""


def swatches() -> Iterator[Row]:
    """Yield the mean error of scenes after measurements, and the expected one, by
    choice.
    """
    for name, scene in product(SETS, range(SCENES)):
        for row in run_scene(inside(spectra(name)), scene):
            yield {"set": name, "scene": scene, **row}


def run_scene(entries: Materials, seed: int) -> Iterator[Row]:
    """Yield choices, numbers of swatches, and mean ΔE00 of a scene as found and as
    expected; the areas of its materials are exponential.
    """
    rng = np.random.default_rng(seed)
    drawn = rng.permutation(len(entries.rgb))[: KNOWN + MATERIALS]
    known, hidden = np.split(drawn, [KNOWN])
    rgb = entries.rgb[hidden]
    areas = rng.exponential(size=len(hidden))
    areas /= areas.sum()
    lights = [observer.light(name) for name in RELIGHT_LIGHTS]
    left_out = families_like(entries.measured)

    def build(swatches: Indices) -> uplift.Cube:
        atlas = entries.take(np.concatenate([known, hidden[swatches]])).atlas
        return uplift.build(atlas, dim=16, leave_out=left_out, scene=ColourSet(rgb))

    def error(cube: uplift.Cube) -> float:
        answers = cube.reflectance(rgb)
        errors = delta_e_under(lights, answers, entries.measured[hidden])
        return areas @ errors.mean(axis=1)

    first = build(np.zeros(0, dtype=int))
    at_first = uncertainty(first, PixelSample(rgb, areas), lights)
    chosen, _ = advise(at_first, COUNTS[-1])
    orders = [("advice", np.array([swatch.colour for swatch in chosen]))]
    draw = partial(rng.choice, len(hidden), COUNTS[-1], replace=False)
    for _ in range(DRAWS):
        orders.append(("random pixels", draw(p=areas)))
        orders.append(("random colours", draw()))
    for choice, order in orders:
        for count in COUNTS:
            expected = at_first
            for swatch in order[:count]:
                expected = expected.measured(int(swatch))
            yield {
                "choice": choice,
                "swatches": count,
                "delta_e": error(build(order[:count])),
                "expected": expected.mean,
            }


QUESTIONS = {"swatches": swatches}
