"""Materials that `uplift advise` chooses to measure, against random choice, for
docs/guides/measuring.md.
"""

from itertools import chain
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, record
from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import in_unit_cube, observer
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
from uplift.extras.report.measures import delta_e_under
from uplift.extras.scene.advice import advise, uncertainty
from uplift.extras.texture.scene_colours import ColourSet, PixelSample
from uplift.fit import families_with

SETS = ("rawtoaces", "cie2017")
SCENES, KNOWN, MATERIALS = 6, 10, 60
"""Scenes of each set, entries that are known at first, and hidden ones that the scene
has at most.
"""
COUNTS = (3, 6, 12, 24)
DRAWS = 2
"""Random choices of each kind."""
ADVICE = "advice"
PIXELS = "random pixels"
COLOURS = "random colours"


def run_scene(entries: Atlas, measured: Array, seed: int) -> list[dict[str, Any]]:
    """Return mean ΔE00 of a scene whose areas are exponentially distributed, by choice
    and number of swatches.
    """
    rng = np.random.default_rng(seed)
    sensor = observer.sensor()
    known, hidden = np.split(
        rng.permutation(len(measured))[: KNOWN + MATERIALS], [KNOWN]
    )
    rgb = np.clip(sensor.rgb(measured[hidden]), 0, 1)
    areas = rng.exponential(size=len(hidden))
    areas /= areas.sum()
    lights = [observer.light(name) for name in RELIGHT_LIGHTS]
    options = {"dim": 16, "leave_out": families_with(measured), "scene": ColourSet(rgb)}

    def build(swatches: Indices) -> uplift.Cube:
        rows = [*known, *hidden[swatches]]
        return uplift.build(
            Atlas(tuple(entries.entries[row] for row in rows)), **options
        )

    def error(cube: uplift.Cube) -> float:
        return float(
            areas
            @ delta_e_under(lights, cube.reflectance(rgb), measured[hidden]).mean(
                axis=1
            )
        )

    first = build(np.zeros(0, dtype=int))
    expected = uncertainty(first, PixelSample(rgb, areas), lights)
    chosen, _ = advise(expected, COUNTS[-1])
    choices = [(ADVICE, np.array([each.colour for each in chosen]))]
    for _ in range(DRAWS):
        choices.append(
            (PIXELS, rng.choice(len(hidden), COUNTS[-1], replace=False, p=areas))
        )
        choices.append((COLOURS, rng.choice(len(hidden), COUNTS[-1], replace=False)))
    start = {"delta_e": error(first), "expected": expected.mean}
    rows = [
        {"choice": name, "swatches": 0, **start} for name in (ADVICE, PIXELS, COLOURS)
    ]
    for name, order in choices:
        remaining = expected
        for step, swatch in enumerate(order, 1):
            remaining = remaining.measured(int(swatch))
            if step in COUNTS:
                found = {
                    "delta_e": error(build(order[:step])),
                    "expected": remaining.mean,
                }
                rows.append({"choice": name, "swatches": step, **found})
    return rows


def main() -> None:
    """Record mean errors by set, choice and number of swatches."""
    results = []
    for name in SETS:
        atlas = read_atlas(ATLASES / f"{name}.txt")
        sensor = observer.sensor()
        measured = resample(atlas, sensor.wavelengths).values
        rows = np.flatnonzero(in_unit_cube(sensor.rgb(measured)))
        atlas = Atlas(tuple(atlas.entries[row] for row in rows))
        measured = measured[rows]
        found = list(
            chain.from_iterable(
                run_scene(atlas, measured, seed) for seed in range(SCENES)
            )
        )
        for choice in (ADVICE, PIXELS, COLOURS):
            figures: dict[str, Any] = {"set": name, "choice": choice}
            for count in (0, *COUNTS):
                some = [
                    row
                    for row in found
                    if (row["choice"], row["swatches"]) == (choice, count)
                ]
                figures |= {
                    f"{key}_{count}": float(np.mean([row[key] for row in some]))
                    for key in ("delta_e", "expected")
                }
            results.append(figures)
    record(
        "advice",
        results=results,
        scenes=SCENES,
        known=KNOWN,
        materials=MATERIALS,
        draws=DRAWS,
        lights=RELIGHT_LIGHTS,
    )
