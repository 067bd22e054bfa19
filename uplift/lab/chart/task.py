"""Test set of the chart: colours of sRGB, and colours of measured spectra that methods do not know."""

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

COLOURS, MIN_COLOURS, SEED = 2000, 16, 1
"""Default and smallest number of random colours, and the seed of their generator."""
EDGE_STEPS = 9
"""Colours along each edge of the RGB cube and along its grey diagonal, corners included."""
MIN_SPECTRA = 2


@dataclass(frozen=True)
class Effort:
    """Time spent on a method.

    Parameters
    ----------
    seconds_per_error : float
        CPU time for the answers of one error; slow methods process fewer colours.
    runs : int
        Largest number of repetitions of a timing.
    lap : float
        Shortest duration of a repetition in seconds.
    batches : tuple of int
        Numbers of colours per call, ascending.
    longest : float
        CPU seconds of a call; slower ones take fewer colours than the batch has.
    builds : int
        Number of builds of each cube; the last one is timed.
    limit : float
        Wall seconds after which a method in a child process counts as hung.
    """

    seconds_per_error: float = 6.0
    runs: int = 7
    lap: float = 0.1
    batches: tuple[int, ...] = (1, 1000, 65_536, 1_000_000)
    longest: float = 1.0
    builds: int = 2
    limit: float = 900.0


QUICK = Effort(seconds_per_error=0.3, runs=3, lap=0.01, batches=(1, 1000, 65_536), longest=0.1, builds=1, limit=120.0)


@dataclass(frozen=True, eq=False)
class Task:
    """Colours and spectra in random order, so that slow methods may process the first of them only.

    Parameters
    ----------
    sensor : Sensor
        Linear sRGB under D65.
    rgb : ndarray, shape (n, 3)
        Random colours, and those along the edges and the grey diagonal of the RGB cube.
    kept : Atlas
        Entries that cubes with an atlas are built from.
    own, unseen : ndarray, shape (k, N) and (m, N)
        Measured spectra of the kept entries and of the others, within sRGB.
    lights : tuple of Light
        Lights of the errors.
    effort : Effort
        Time spent on a method.
    facts : mapping of str to str
        Description for the reader.
    """

    sensor: Sensor
    rgb: Array
    kept: Atlas
    own: Array
    unseen: Array
    lights: tuple[Light, ...]
    effort: Effort
    facts: Mapping[str, str]


def make_task(atlases: Mapping[str, Atlas], colours: int = COLOURS, effort: Effort | None = None) -> Task:
    """Make a task from measured spectra: of each atlas the first, third, … entry builds cubes, the others test them.

    Parameters
    ----------
    atlases : mapping of str to Atlas
        Atlases by name.
    colours : int, default 2000
        Number of random colours.
    effort : Effort, optional
        Time spent on a method.

    Returns
    -------
    Task
        The same for equal arguments.

    Raises
    ------
    OptionError
        If there are too few colours.
    AtlasError
        If too few entries are within sRGB, or two have the same name.
    """
    if colours < MIN_COLOURS:
        raise OptionError(f"colours must be at least {MIN_COLOURS}, got {colours}", code="too-few-colours")
    sensor = observer.sensor()
    kept, others = (_every_second(atlases.values(), start) for start in (0, 1))
    own, unseen = (_in_gamut(sensor, part) for part in (kept, others))
    if min(len(own), len(unseen)) < MIN_SPECTRA:
        raise AtlasError(
            f"at least {MIN_SPECTRA} entries within sRGB must build and test cubes each, "
            f"got {len(own)} and {len(unseen)}",
            code="too-few-entries",
            hint="give an atlas of 8 or more entries",
        )
    rng = np.random.default_rng(SEED)
    rgb = np.concatenate([rng.random((colours, 3)), edges()])
    facts = {
        "colours": f"{colours:,} random and {len(edges())} along edges and greys of linear sRGB, under D65",
        "spectra": f"{len(kept)} of {len(kept) + len(others)} entries of {', '.join(atlases)} (every second) build "
        f"the cubes with an atlas; of the others, {len(unseen)} within sRGB test all methods",
    }
    return Task(
        sensor,
        rng.permutation(rgb),
        kept,
        rng.permutation(own),
        rng.permutation(unseen),
        tuple(observer.light(name) for name in CHART_LIGHTS),
        effort or Effort(),
        facts,
    )


def edges() -> Array:
    """Return linear RGB (n, 3) along the edges and the grey diagonal of the RGB cube, each once."""
    along = np.linspace(0, 1, EDGE_STEPS)
    ends = product((0.0, 1.0), repeat=2)
    lines = [np.insert(np.tile(end, (EDGE_STEPS, 1)), axis, along, axis=1) for end in ends for axis in range(3)]
    return np.unique(np.concatenate([*lines, np.repeat(along[:, None], 3, axis=1)]), axis=0)


def _every_second(atlases: Iterable[Atlas], start: int) -> Atlas:
    return merge(Atlas(atlas.entries[start::2], (), atlas.sources) for atlas in atlases)


def _in_gamut(sensor: Sensor, atlas: Atlas) -> Array:
    values = resample(atlas, sensor.wavelengths).values
    return values[sensor.contains(sensor.rgb(values))]
