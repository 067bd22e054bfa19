"""Interface of methods of spectral upsampling to the chart, and the sensors by which
their round trips are measured.

Round trips are measured at 1 nm, with the observer, the illuminant, the white and the
matrix that a method states. No method was fitted at 1 nm. Cubes are fitted to 380–780
nm at 5 nm: errors there would favour our range, step and matrix.
"""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import Any, TypeVar

import numpy as np

from uplift.atlas import Atlas, merge, resample
from uplift.colorimetry import Sensor, in_unit_cube, observer
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT
from uplift.common.arrays import Array, Values
from uplift.common.colour_science import colour_science
from uplift.common.errors import AtlasError, OptionError
from uplift.common.text import pluralise

RANGE = (360.0, 830.0, 1.0)
"""First and last wavelength and step in nm: those of the CIE 1931 observer."""


def at_1_nm(sensor: Sensor) -> Sensor:
    """Return a sensor on `RANGE`, the statement of a cube: its white stays white."""
    return observer.on_range(sensor, *RANGE)


def stated_sensor(xyz_to_rgb: Array, illuminant: str = DEFAULT_ILLUMINANT) -> Sensor:
    """Return the sensor on `RANGE` of a stated matrix (3, 3)."""
    sensor = observer.sensor(illuminant=illuminant)
    return replace(at_1_nm(sensor), xyz_to_rgb=xyz_to_rgb)


@cache
def ours() -> Sensor:
    """Return the statement of cubes for linear sRGB under D65."""
    return at_1_nm(observer.sensor())


@cache
def published_srgb() -> Sensor:
    """Return the statement of methods for sRGB: the matrix of IEC 61966-2-1, D65."""
    return stated_sensor(colour_science().RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB)


COLOURS = 2000
"""Default number of random colours."""
MIN_COLOURS = 16
MIN_SPECTRA = 2


@dataclass(frozen=True)
class Effort:
    """Time spent on a method.

    ``seconds_per_error``: CPU time for the answers of one error; slow methods process
    fewer colours. ``lap``: shortest duration of a repetition in seconds. ``longest``:
    CPU seconds of a call; slower ones take fewer colours than the batch has.
    ``builds``: number of builds of each cube; the last one is timed. ``limit``: wall
    seconds after which a method in a child process counts as hung.
    """

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
class Task:
    """Colours and spectra in random order, so that slow methods may process the first
    of them only.

    ``sensor``: linear sRGB under D65. ``rgb`` (n, 3): random colours, and those along
    the edges and the grey diagonal of the RGB cube. ``kept``: entries that cubes with
    an atlas are built from. ``own``, ``unseen`` (k, N) and (m, N): measured spectra of
    the kept entries and of the others, within sRGB.
    """

    sensor: Sensor
    rgb: Array
    kept: Atlas
    own: Array
    unseen: Array
    effort: Effort
    facts: Mapping[str, str]


def make_task(
    atlases: Mapping[str, Atlas], colours: int = COLOURS, effort: Effort | None = None
) -> Task:
    """Make a task from measured spectra: of each atlas the first, third, … entry builds
    cubes, the others test them.

    Raises `OptionError`, `AtlasError`.
    """
    if colours < MIN_COLOURS:
        raise OptionError(f"colours must be at least {MIN_COLOURS}, got {colours}")
    sensor = observer.sensor()
    kept = _every_second(atlases, 0)
    others = _every_second(atlases, 1)
    own = _within_srgb(kept, sensor)
    unseen = _within_srgb(others, sensor)
    if min(len(own), len(unseen)) < MIN_SPECTRA:
        problem = (
            f"at least {MIN_SPECTRA} entries within sRGB must build and test cubes "
            f"each, got {len(own)} and {len(unseen)}"
        )
        hint = "give an atlas of 8 or more entries"
        raise AtlasError(problem, code="too-few-entries", hint=hint)
    rng = np.random.default_rng(1)
    rgb = np.concatenate([rng.random((colours, 3)), edges()])
    facts = {
        "colours": (
            f"{colours:,} random and {len(edges())} along edges and greys of linear "
            "sRGB, under D65"
        ),
        "spectra": f"{len(kept)} of {pluralise(len(kept) + len(others), 'entry')} of "
        f"{', '.join(atlases)} (every "
        f"second) build the cubes with an atlas; of the others, {len(unseen)} within "
        "sRGB test all methods",
    }
    return Task(
        sensor,
        rng.permutation(rgb),
        kept,
        rng.permutation(own),
        rng.permutation(unseen),
        effort or Effort(),
        facts,
    )


def _every_second(atlases: Mapping[str, Atlas], start: int) -> Atlas:
    """Return every second entry of each atlas from ``start``."""
    return merge(
        Atlas(atlas.entries[start::2], (), atlas.sources) for atlas in atlases.values()
    )


def _within_srgb(atlas: Atlas, sensor: Sensor) -> Array:
    """Return the spectra (n, N) of an atlas whose RGB are in [0, 1]."""
    spectra = resample(atlas, sensor.wavelengths).values
    return spectra[in_unit_cube(sensor.rgb(spectra))]


def edges() -> Array:
    """Return linear RGB (n, 3) along the edges and the grey diagonal of the RGB cube,
    each once.
    """
    along = np.linspace(0, 1, 9)
    grid = np.array(list(product(along, repeat=3)))
    at_ends = ((grid == 0) | (grid == 1)).sum(axis=1)
    return grid[(at_ends >= 2) | (np.ptp(grid, axis=1) == 0)]


Result = TypeVar("Result")
Uplift = Callable[[Values, Array], Values]
"""From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N),
in the method's data type.
"""


class NotInstalledError(Exception):
    """A package that a method needs is missing; the text names it."""


@dataclass(frozen=True, eq=False)
class PreparedMethod:
    """A method ready for use.

    ``build_s``: CPU seconds to compute its tables, once; 0 if there are none to
    compute, None if they come from
        elsewhere.
    ``load_s``: CPU seconds to read and prepare them in a process. The first call, which
    may compile, is charged
        separately.
    """

    uplift: Uplift
    bytes: int
    build_s: float | None = 0.0
    load_s: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Description:
    """Texts about a method: columns of the table of a chart.

    ``method``, ``title``: name for the command line, and name to display. ``label``:
    label of its marker, by default the title. ``family``, ``source``: name in the
    legend, and publication. ``mode``: mode of lookup of a cube, which determines the
    shape of the marker. ``build``, ``call``: command and call that give a user of this
    package the same; empty for other methods.
    """

    method: str
    title: str
    label: str = ""
    family: str
    source: str
    mode: str = ""
    dtype: str = "float64"
    build: str = ""
    call: str = ""
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Method(Description):
    """A method of spectral upsampling. A method far off the claims of its authors is
    broken and is not drawn.

    ``prepare``: from a `Task` to a `PreparedMethod`. Raises `NotInstalledError`.
    ``reference_sensor``: returns the sensor of the white and the matrix that the method
    states, see `published_srgb`. ``claimed_error``: mean ΔE00 of round trips that its
    authors claim. ``claimed_range``: range of reflectances that its authors claim.
    ``batch``: whether it accepts many colours per call; otherwise it loops over them.
    ``needs``: native code beyond this package and how to install it; empty if there is
    none. A method that needs some
        is measured in a child process, as it may crash or hang.
    """

    prepare: Callable[[Task], PreparedMethod]
    reference_sensor: Callable[[], Sensor] = published_srgb
    claimed_error: float | None = None
    claimed_range: tuple[float, float] = (0.0, 1.0)
    batch: bool = True
    needs: str = ""


def stopwatch(function: Callable[[], Result]) -> tuple[Result, float]:
    """Call a function; return its result and the CPU seconds of all threads."""
    begin = time.process_time()
    result = function()
    return result, time.process_time() - begin


def nbytes(*arrays: Values | Any) -> int:
    """Size of arrays."""
    return sum(array.nbytes for array in arrays)
