"""Materials that `uplift advise` chooses to measure, against random choice, for
docs/guides/measuring.md.
"""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import chain

import numpy as np

import uplift
from benchmarks import ATLASES, Row, record
from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import in_unit_cube, observer
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
from uplift.extras.report.measures import delta_e_under
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
COUNTS = (3, 6, 12, 24)
DRAWS = 2
"""Random choices of each kind."""
CHOICES = ADVICE, PIXELS, COLOURS = ("advice", "random pixels", "random colours")


def run_scene(entries: Atlas, measured: Array, seed: int) -> list[Row]:
    """Return mean ΔE00 by choice and number of swatches; areas are exponential."""
    rng = np.random.default_rng(seed)
    drawn = rng.permutation(len(measured))[: KNOWN + MATERIALS]
    known, hidden = np.split(drawn, [KNOWN])
    rgb = np.clip(observer.sensor().rgb(measured[hidden]), 0, 1)
    areas = rng.exponential(size=len(hidden))
    areas /= areas.sum()
    lights = [observer.light(name) for name in RELIGHT_LIGHTS]
    options = {"dim": 16, "leave_out": families_like(measured), "scene": ColourSet(rgb)}

    def build(swatches: Indices) -> uplift.Cube:
        return uplift.build(select(entries, [*known, *hidden[swatches]]), **options)

    def error(cube: uplift.Cube) -> float:
        errors = delta_e_under(lights, cube.reflectance(rgb), measured[hidden])
        return areas @ errors.mean(axis=1)

    first = build(np.zeros(0, dtype=int))
    expected = uncertainty(first, PixelSample(rgb, areas), lights)
    chosen, _ = advise(expected, COUNTS[-1])
    choices = [(ADVICE, np.array([swatch.colour for swatch in chosen]))]
    draw = partial(rng.choice, len(hidden), COUNTS[-1], replace=False)
    for _ in range(DRAWS):
        choices.append((PIXELS, draw(p=areas)))
        choices.append((COLOURS, draw()))
    start = {"swatches": 0, "delta_e": error(first), "expected": expected.mean}
    rows = [{"choice": name, **start} for name in CHOICES]
    for name, order in choices:
        remaining = expected
        for step, swatch in enumerate(order, 1):
            remaining = remaining.measured(int(swatch))
            if step in COUNTS:
                rows.append(
                    {
                        "choice": name,
                        "swatches": step,
                        "delta_e": error(build(order[:step])),
                        "expected": remaining.mean,
                    }
                )
    return rows


def select(atlas: Atlas, rows: Sequence[int]) -> Atlas:
    """Return the entries of an atlas in rows."""
    return Atlas(tuple(atlas.entries[row] for row in rows))


def summaries(name: str) -> Iterator[Row]:
    """Yield mean errors over the scenes of a set by choice."""
    atlas = read_atlas(ATLASES / f"{name}.txt")
    sensor = observer.sensor()
    measured = resample(atlas, sensor.wavelengths).values
    inside = np.flatnonzero(in_unit_cube(sensor.rgb(measured)))
    entries = select(atlas, inside)
    rows = []
    for seed in range(SCENES):
        rows += run_scene(entries, measured[inside], seed)
    for choice in CHOICES:
        figures = {"set": name, "choice": choice}
        for count in (0, *COUNTS):
            key = (choice, count)
            same = [row for row in rows if (row["choice"], row["swatches"]) == key]
            for figure in ("delta_e", "expected"):
                figures[f"{figure}_{count}"] = np.mean([row[figure] for row in same])
        yield figures


def main() -> None:
    """Record mean errors by set, choice and number of swatches."""
    record(
        "advice",
        results=chain.from_iterable(map(summaries, SETS)),
        scenes=SCENES,
        known=KNOWN,
        materials=MATERIALS,
        draws=DRAWS,
        lights=RELIGHT_LIGHTS,
    )
