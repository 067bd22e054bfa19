"""What every method is asked: colours of sRGB, and those of measured spectra that it has not been shown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.atlas import Atlas, merge, resample
from uplift.colorimetry import observer
from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError, OptionError

COLOURS, FEWEST, SEED = 2000, 16, 1
"""Random colours by default, the fewest that make a statistic, and what they are drawn from."""
STEPS = 9
"""Colours along each edge of the RGB cube, and along its grey diagonal, corners included."""


@dataclass(frozen=True)
class Effort:
    """How much time a method may take.

    ``answering`` seconds for the colours of an error, after which no more are asked; ``runs`` of at least
    ``lap`` seconds each for a time, of no more than ``batch`` colours; ``builds`` of a cube, the last one counted.
    """

    answering: float = 10.0
    runs: int = 7
    lap: float = 0.1
    batch: int = 1 << 16
    builds: int = 2


QUICK = Effort(answering=0.3, runs=3, lap=0.01, batch=1 << 12, builds=1)


@dataclass(frozen=True, eq=False)
class Task:
    """The questions, in an order of no meaning, so that slow methods may answer the first of them only.

    Parameters
    ----------
    sensor : linear sRGB under D65.
    rgb : (n, 3) random colours, and those along the edges and the grey diagonal of the RGB cube.
    kept : the entries that cubes with an atlas are built from.
    own, unseen : (k, N), (m, N) measured spectra of the kept entries and of the others, within sRGB.
    lights : to look under.
    facts : what of this a reader must know.
    """

    sensor: Sensor
    rgb: Array
    kept: Atlas
    own: Array
    unseen: Array
    lights: tuple[Light, ...]
    effort: Effort
    facts: Mapping[str, str]


def task(atlases: Mapping[str, Atlas], colours: int = COLOURS, effort: Effort | None = None) -> Task:
    """Questions from measured spectra: of each atlas every second entry, from the first, builds; the others are asked.

    Raises
    ------
    OptionError : too few colours.
    AtlasError : too few entries within sRGB to ask for, or two of one name.
    """
    if colours < FEWEST:
        raise OptionError(f"{colours} colours say nothing", hint=f"ask for {FEWEST} or more")
    sensor = observer.sensor()
    kept, unseen = (_every_second(atlases.values(), start) for start in (0, 1))
    own, asked = (_within(sensor, part) for part in (kept, unseen))
    if min(len(own), len(asked)) < 2:
        raise AtlasError(
            f"{len(asked)} of the entries to ask for lie within sRGB",
            hint="give an atlas of 8 or more entries",
        )
    rng = np.random.default_rng(SEED)
    rgb = np.concatenate([rng.random((colours, 3)), edges()])
    facts = {
        "colours": f"{colours:,} random and {len(edges())} along edges and greys of linear sRGB, under D65",
        "spectra": f"{len(kept)} of {len(kept) + len(unseen)} entries of {', '.join(atlases)} (every second) build "
        f"the cubes with an atlas; the other half's {len(asked)} within sRGB are asked for",
    }
    return Task(
        sensor,
        rng.permutation(rgb),
        kept,
        rng.permutation(own),
        rng.permutation(asked),
        tuple(observer.light(name) for name in CHART_LIGHTS),
        effort or Effort(),
        facts,
    )


def edges() -> Array:
    """Linear RGB (n, 3) along the edges and the grey diagonal of the RGB cube, each once."""
    along = np.linspace(0, 1, STEPS)
    ends = product((0.0, 1.0), repeat=2)
    lines = [np.insert(np.tile(end, (STEPS, 1)), axis, along, axis=1) for end in ends for axis in range(3)]
    return np.unique(np.concatenate([*lines, np.repeat(along[:, None], 3, axis=1)]), axis=0)


def _every_second(atlases: Iterable[Atlas], start: int) -> Atlas:
    return merge(Atlas(spectra.entries[start::2], (), spectra.sources) for spectra in atlases)


def _within(sensor: Sensor, spectra: Atlas) -> Array:
    values = resample(spectra, sensor.wavelengths).values
    return values[sensor.contains(sensor.rgb(values))]
