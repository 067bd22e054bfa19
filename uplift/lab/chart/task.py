"""The task of a chart: colours, and measured spectra of which every second one is
known.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.atlas.atlas import Atlas, merge
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError
from uplift.common.text import pluralise
from uplift.lab.look_alikes import families_like
from uplift.lab.runner import Task, spectra_of, within

MIN_SPECTRA = 2


@dataclass(frozen=True)
class Effort:
    """Time spent on a method.

    ``colours``: number of random colours of the round trip. ``seconds_per_error``: CPU
    time for the answers of one error; slow methods process fewer colours. ``lap``:
    shortest duration of a repetition in seconds. ``longest``: CPU seconds of a call;
    slower ones take fewer colours than the batch has. ``builds``: number of builds of
    each cube; the last one is timed. ``limit``: wall seconds after which a method in a
    child process counts as hung.
    """

    colours: int = 2000
    seconds_per_error: float = 6.0
    runs: int = 7
    lap: float = 0.02
    batches: tuple[int, ...] = (1, 1000, 65_536, 1_000_000)
    longest: float = 1.0
    builds: int = 2
    limit: float = 900.0


QUICK = Effort(
    seconds_per_error=0.3,
    runs=3,
    lap=0.002,
    batches=(1, 1000, 65_536),
    longest=0.1,
    builds=1,
    limit=120.0,
)


@dataclass(frozen=True, eq=False)
class ChartTask:
    """The queries of a chart, in random order, so that slow methods may process the
    first ones only.

    ``unseen``: spectra that no method knows, next to those that it knows. ``colours``
    (n, 3): random RGB, and those along the edges and the grey diagonal of the RGB cube.
    """

    unseen: Task
    colours: Array
    effort: Effort
    facts: Mapping[str, str]


def make_task(atlases: Mapping[str, Atlas], effort: Effort | None = None) -> ChartTask:
    """Make a task from measured spectra in linear sRGB: of each atlas the first, third,
    … entry builds cubes, the others test them.

    Raises `AtlasError`.
    """
    effort = effort or Effort()
    sensor = observer.sensor()
    known = merge(atlas[::2] for atlas in atlases.values())
    others = merge(atlas[1::2] for atlas in atlases.values())
    random = np.random.default_rng(1)
    rgb = np.concatenate([random.random((effort.colours, 3)), edges()])
    rgb = random.permutation(rgb)
    unseen = random.permutation(spectra_of(within(others, sensor), sensor))
    task = Task(sensor, known, unseen, families_like(unseen), effort.builds)
    own = task.known_spectra
    if min(len(own), len(unseen)) < MIN_SPECTRA:
        problem = (
            f"at least {MIN_SPECTRA} entries within sRGB must build and test cubes "
            f"each, got {len(own)} and {len(unseen)}"
        )
        hint = "give an atlas of 8 or more entries"
        raise AtlasError(problem, code="too-few-entries", hint=hint)
    facts = {
        "colours": (
            f"{effort.colours:,} random and {len(edges())} along edges and greys of "
            "linear sRGB, under D65"
        ),
        "spectra": f"{len(known)} of {pluralise(len(known) + len(others), 'entry')} of "
        f"{', '.join(atlases)} (every "
        f"second) build the cubes with an atlas; of the others, {len(unseen)} within "
        "sRGB test all methods",
    }
    return ChartTask(task, rgb, effort, facts)


def edges() -> Array:
    """Return linear RGB (n, 3) along the edges and the grey diagonal of the RGB cube,
    each once.
    """
    along = np.linspace(0, 1, 9)
    grid = np.array(list(product(along, repeat=3)))
    at_ends = ((grid == 0) | (grid == 1)).sum(axis=1)
    return grid[(at_ends >= 2) | (np.ptp(grid, axis=1) == 0)]
