"""Interface of methods of spectral upsampling to the chart, and the judge of their round trips.

The judge is the observer and the illuminant at 1 nm, with the white and the matrix that a method states. No method was
fitted to these functions. Cubes are fitted to 380–780 nm at 5 nm, where other methods would be judged by our
choice of range, step and matrix."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import product
from typing import TypeVar

import numpy as np

from uplift.atlas import Atlas, merge, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.lights import CHART_LIGHTS, DEFAULT_ILLUMINANT
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Values
from uplift.common.colour_science import colour_science
from uplift.common.errors import AtlasError, OptionError

RANGE = (360.0, 830.0, 1.0)
"""First and last wavelength and step in nm: the tables of the CIE."""


def at_1_nm(sensor: Sensor) -> Sensor:
    """Return a sensor on `RANGE`, where the perfect reflector is white again: the statement of a cube."""
    return observer.on_range(sensor, *RANGE)


def stated_sensor(xyz_to_rgb: Array, illuminant: str = DEFAULT_ILLUMINANT) -> Sensor:
    """Return the sensor on `RANGE` of a stated matrix. Shapes: ``xyz_to_rgb`` (3, 3)."""
    return replace(at_1_nm(observer.sensor(illuminant=illuminant)), xyz_to_rgb=xyz_to_rgb)


@cache
def ours() -> Sensor:
    """Return the statement of cubes for linear sRGB under D65."""
    return at_1_nm(observer.sensor())


@cache
def published_srgb() -> Sensor:
    """Return the statement of methods for sRGB: the matrix of IEC 61966-2-1, D65."""
    return stated_sensor(colour_science().RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB)


def round_trip(sensor: Sensor, rgb: Array, spectra: Array) -> Array:
    """Compare colours with those of their spectra. Shapes: ``rgb`` (n, 3), ``spectra`` (n, N); result (n,)."""
    return delta_e_rgb(sensor, rgb, sensor.rgb(spectra))


COLOURS, MIN_COLOURS, SEED = 2000, 16, 1
"""Default and smallest number of random colours, and the seed of their generator."""
EDGE_STEPS = 9
"""Colours along each edge of the RGB cube and along its grey diagonal, corners included."""
MIN_SPECTRA = 2


@dataclass(frozen=True)
class Effort:
    """Time spent on a method.

    ``seconds_per_error``: CPU time for the answers of one error; slow methods process fewer colours.
    ``runs``: largest number of repetitions of a timing.
    ``lap``: shortest duration of a repetition in seconds.
    ``batches``: numbers of colours per call, ascending.
    ``longest``: CPU seconds of a call; slower ones take fewer colours than the batch has.
    ``builds``: number of builds of each cube; the last one is timed.
    ``limit``: wall seconds after which a method in a child process counts as hung.
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

    ``sensor``: linear sRGB under D65.
    ``rgb`` (n, 3): random colours, and those along the edges and the grey diagonal of the RGB cube.
    ``kept``: entries that cubes with an atlas are built from.
    ``own``, ``unseen`` (k, N) and (m, N): measured spectra of the kept entries and of the others, within sRGB.
    ``lights``: lights of the errors.
    ``effort``: time spent on a method.
    ``facts``: description for the reader.
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

    Raises `OptionError`, `AtlasError`.
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


Result = TypeVar("Result")
Uplift = Callable[[Values, Array], Values]
"""From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N), in the method's data type."""
DTYPES = ("float64", "float32")


class NotInstalledError(Exception):
    """A package that a method needs is missing; the text names it."""


@dataclass(frozen=True)
class Claims:
    """Properties that the authors of a method claim. A method far off its claims is broken and is not drawn.

    ``round_trip``: mean ΔE00 of round trips.
    ``min``, ``max``: range of reflectances.
    """

    round_trip: float | None = None
    min: float = 0.0
    max: float = 1.0


@dataclass(frozen=True, eq=False)
class PreparedMethod:
    """A method ready for use.

    ``uplift``: from linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N).
    ``bytes``: size of its tables.
    ``build_s``: CPU seconds to compute its tables, once; 0 if there are none to compute, None if they come from
        elsewhere.
    ``load_s``: CPU seconds to read and prepare them in a process. The first call, which may compile, is charged
        separately.
    """

    uplift: Uplift
    bytes: int
    build_s: float | None = 0.0
    load_s: float = 0.0


@dataclass(frozen=True)
class Method:
    """A method of spectral upsampling.

    ``name``, ``title``: name for the command line, and name to display.
    ``prepare``: from a `Task` to a `PreparedMethod`. Raises `NotInstalledError`.
    ``claims``: claims that its answers are checked against.
    ``dtype``: data type of colours and reflectances.
    ``judge``: returns the sensor of the white and the matrix that the method states; see `uplift.lab.chart.method`.
    ``batch``: whether it accepts many colours per call; otherwise ``uplift`` loops over them.
    ``usual``, ``quick``: whether it is measured if no methods are named, and in a quick run.
    ``label``: label of its marker, by default the title.
    ``mode``: mode of lookup, which determines the shape of the marker.
    ``build``, ``call``: command and call that give a user of this package the same; empty for other methods.
    ``note``: remark for the reader.
    ``needs``: native code beyond this package and how to install it; empty if there is none. A method that needs some
        is measured in a child process, as it may crash or hang.
    """

    name: str
    title: str
    prepare: Callable[[Task], PreparedMethod]
    claims: Claims = field(default_factory=Claims)
    dtype: str = "float64"
    judge: Callable[[], Sensor] = published_srgb
    batch: bool = True
    usual: bool = True
    quick: bool = False
    label: str = ""
    mode: str = ""
    build: str = ""
    call: str = ""
    note: str = ""
    needs: str = ""


@dataclass(frozen=True)
class Family:
    """Methods with a common name, source and colour (``#rrggbb``) in the legend."""

    name: str
    source: str
    colour: str
    methods: tuple[Method, ...]


def in_both_types(method: Method, prepare: Callable[[Task, str], PreparedMethod]) -> tuple[Method, Method]:
    """Return a method in float64, and in float32 with ``-float32`` after its name."""
    single = replace(
        method,
        name=f"{method.name}-float32",
        title=f"{method.title}, float32",
        label=f"{method.label or method.title} f32",
        prepare=lambda task: prepare(task, "float32"),
        dtype="float32",
        quick=False,
    )
    return replace(method, prepare=lambda task: prepare(task, "float64")), single


def stopwatch(function: Callable[[], Result]) -> tuple[Result, float]:
    """Call a function; return its result and the CPU seconds of all threads."""
    begin = time.process_time()
    result = function()
    return result, time.process_time() - begin


def one_by_one(spectrum: Callable[[Array], tuple[Array, Array]]) -> Uplift:
    """Extend a function of one colour to many."""

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        return np.stack([np.interp(wavelengths, *spectrum(colour)) for colour in rgb])

    return uplift


def nbytes(arrays: Mapping[str, Array] | tuple[Array, ...]) -> int:
    """Size of arrays."""
    return sum(array.nbytes for array in (arrays.values() if isinstance(arrays, Mapping) else arrays))
