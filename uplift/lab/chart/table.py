"""A chart as rows of numbers and as CSV, its panels with Pareto fronts, and the recommendation of a cube."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from importlib.resources import files

import numpy as np

from uplift.colorimetry.lights import CHART_LIGHTS, DEFAULT_ILLUMINANT
from uplift.common.csv import csv_text
from uplift.common.errors import ChartFileError, OptionError, unknown_name
from uplift.common.files import read_bytes
from uplift.common.text import format_value, parse_float, shorten
from uplift.viz.format import format_error, format_time
from uplift.viz.scatter import pareto_front

FACTS = ("machine", "versions", "commit", "colours", "spectra", "effort")
"""Columns with the same text in all rows."""
MAX_BYTES = 16 << 20
"""Largest file that is read."""
MAX_NUMBER = 1e30
REQUIRED = (
    "bytes",
    "time_ns",
    "setup_s",
    "round_trip_mean",
    "coarse_round_trip_mean",
    "round_trip_colours",
    "unseen_spectra",
)
"""Numbers of every method that was measured."""
BATCH = re.compile(r"ns_([1-9]\d{0,8})")
"""Name of a time by the number of colours per call."""
KINDS = ("mean", "p99", "max")
"""Suffixes of the numbers of an error, which come together."""
HINT = "give the CSV file of a chart"


class State(StrEnum):
    """Whether a method was measured; only measured ones are drawn."""

    MEASURED = "measured"
    BROKEN = "broken"
    MISSING = "not installed"


@dataclass(frozen=True, eq=False)
class MethodResult:
    """Result of a method. The fields are the columns of the CSV file.

    ``method``, ``title``, ``label``, ``family``, ``source``, ``mode``, ``dtype``, ``build``, ``note``: as in `Method`
        and `Family`. The field `ask` is ``Method.call``.
    ``state``: whether the method was measured.
    ``why``: the reason if it was not.
    ``numbers``: ``bytes``; CPU seconds ``build_s``, ``load_s`` and ``setup_s``, their sum; ``ns_N`` per RGB with N
        colours per call, see `uplift.lab.chart.measure.call_times`; ``time_ns``, that of the recommendation. Errors
        ``round_trip`` (judged at 1 nm), ``coarse_round_trip`` (with the tables of cubes), of every light, ``lights``
        (their mean) and ``rms``, and prefixed by ``own_`` those at entries that cubes were built from, each with
        ``_mean``, ``_p99`` and ``_max``. Sizes ``round_trip_colours``, ``unseen_spectra`` and ``own_spectra`` of the
        test set.
    """

    method: str
    title: str
    label: str
    family: str
    source: str
    mode: str
    dtype: str
    build: str
    ask: str
    note: str
    state: State
    why: str
    numbers: Mapping[str, float]


@dataclass(frozen=True)
class Chart:
    """Results of all methods.

    ``facts``: machine, versions and test set; see `FACTS`.
    ``results``: the results.
    """

    facts: Mapping[str, str]
    results: tuple[MethodResult, ...]

    @property
    def measured(self) -> tuple[MethodResult, ...]:
        """Return the results of the methods that were measured."""
        return tuple(result for result in self.results if result.state == State.MEASURED)

    @property
    def batches(self) -> tuple[int, ...]:
        """Return the numbers of colours per call that were timed, ascending."""
        names = {name for result in self.measured for name in result.numbers}
        return tuple(sorted(int(match[1]) for name in names if (match := BATCH.fullmatch(name))))


TEXTS = tuple(field.name for field in fields(MethodResult) if field.name != "numbers")


def chart_csv(chart: Chart) -> str:
    """Convert a chart to CSV."""
    names = list(dict.fromkeys(name for result in chart.results for name in result.numbers))
    facts = [chart.facts.get(name, "") for name in FACTS]
    rows = []
    for result in chart.results:
        numbers = (f"{result.numbers[name]:.6g}" if name in result.numbers else "" for name in names)
        rows.append([*(getattr(result, name) for name in TEXTS), *numbers, *facts])
    return csv_text([*TEXTS, *names, *FACTS], rows)


def read_chart(path: str | os.PathLike[str]) -> Chart:
    """Read the CSV file of a chart. Raises `ChartFileError`."""
    data = read_bytes(path, ChartFileError, limit=MAX_BYTES, hint=HINT)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _chart_error(path, "not a UTF-8 text file", "file-unreadable") from error
    return parse_chart(text, path)


def parse_chart(text: str, path: str | os.PathLike[str]) -> Chart:
    """Parse the text of a chart's CSV file. Raises `ChartFileError`."""
    reader = csv.DictReader(io.StringIO(text))
    try:
        if not {*TEXTS, *FACTS} <= set(reader.fieldnames or ()):
            raise _chart_error(path, "is not the table of a chart", "not-a-chart")
        lines = list(reader)
        results = tuple(_result(line) for line in lines)
    except ChartFileError:
        raise
    except (ValueError, TypeError, csv.Error) as error:
        raise _chart_error(path, f"is not a valid chart: {error}", "invalid-chart") from error
    if not results:
        raise _chart_error(path, "contains no methods", "chart-without-methods")
    return Chart({name: lines[0][name] for name in FACTS}, results)


def _result(line: dict[str, str]) -> MethodResult:
    if None in line or None in line.values():
        raise ValueError("lines differ in length")
    texts = {name: line[name] for name in TEXTS if name != "state"}
    numbers = {name: _number(line, name) for name in line if name not in (*TEXTS, *FACTS) and line[name].strip()}
    state = State(line["state"])
    if state == State.MEASURED:
        for name in _required(numbers):
            if name not in numbers:
                raise ValueError(f"{format_value(line['method'])} has no {name}")
    return MethodResult(**texts, state=state, numbers=numbers)


def _number(line: dict[str, str], name: str) -> float:
    text = line[name].strip()
    try:
        value = parse_float(text)
    except ValueError:
        value = -1
    if not 0 <= value <= MAX_NUMBER:
        raise ValueError(f"{shorten(name)} must be in [0, {MAX_NUMBER:g}], got {format_value(text)}")
    return value


def _required(numbers: Mapping[str, float]) -> Iterator[str]:
    """Names of the numbers that a measured method with these has."""
    yield from REQUIRED
    for name in numbers:
        stem, _, kind = name.rpartition("_")
        if kind in KINDS:
            yield from (f"{stem}_{each}" for each in KINDS)
        if BATCH.fullmatch(name):
            yield from (f"{name}_{each}" for each in ("least", "most", "colours"))


def _chart_error(path: str | os.PathLike[str], problem: str, code: str) -> ChartFileError:
    return ChartFileError(problem, code=code, path=path, hint=HINT)


MIN_TIME = 1.0
"""Left end of the time axes in ns."""
MIN_ERROR = 1e-4
"""Smaller errors are not visible and are drawn here, so that the faster of two such methods is on the front."""
CLEAR_RATIO = 0.99
"""Share of an error below which another one is clearly smaller; the rest is noise."""


@dataclass(frozen=True)
class Panel:
    """A panel of error over time.

    ``title``: title, without the number of colours.
    ``error``: name of the error in `MethodResult.numbers`, without ``_mean``; the mean is drawn.
    ``unit``: its unit.
    ``batch``: number of colours per call.
    ``whole``: whether time is that of all colours of the batch and of the set-up, instead of that per RGB.
    ``whiskers``: whether lines join the mean with the 99 % quantile and the largest error.
    """

    title: str
    error: str
    unit: str
    batch: int
    whole: bool = False
    whiskers: bool = False

    @property
    def colours(self) -> str:
        """Return the number of colours per call as text."""
        return f"{self.batch:,} colour{'s' if self.batch > 1 else ''} per call"

    @property
    def axis(self) -> str:
        """Return the label of the time axis."""
        return "CPU time of a call, with set-up" if self.whole else "CPU time per RGB"

    def time(self, result: MethodResult) -> float | None:
        """Return the time in ns, None if it is unknown."""
        each = result.numbers.get(f"ns_{self.batch}")
        if each is None or not self.whole:
            return each
        return 1e9 * result.numbers["setup_s"] + self.batch * each

    def point(self, result: MethodResult) -> tuple[float, float] | None:
        """Return time and mean error, None if either is unknown."""
        time, error = self.time(result), result.numbers.get(f"{self.error}_mean")
        if time is None or error is None:
            return None
        return max(time, MIN_TIME), max(error, MIN_ERROR)

    def labels(self, result: MethodResult) -> tuple[str, str]:
        """Return time and mean error as text."""
        return format_time(self.time(result) or 0.0), format_error(result.numbers[f"{self.error}_mean"])

    def whisker(self, result: MethodResult) -> tuple[float, float]:
        """Return the 99 % quantile and the largest error."""
        p99, largest = (result.numbers[f"{self.error}_{kind}"] for kind in ("p99", "max"))
        return max(p99, MIN_ERROR), max(largest, MIN_ERROR)

    def front(self, chart: Chart) -> tuple[MethodResult, ...]:
        """Return the Pareto front, fastest first: each is clearly more accurate than all faster methods."""
        points = [(result, point) for result in chart.measured if (point := self.point(result)) is not None]
        array = np.array([point for _, point in points]).reshape(-1, 2)
        return tuple(points[row][0] for row in pareto_front(array, CLEAR_RATIO))


UNSEEN = "Unseen materials, mean of five lights"


def panels_of(batch: int) -> tuple[Panel, ...]:
    """Return the panels of a number of colours per call."""
    return (
        Panel("Round trip, judged at 1 nm", "round_trip", "ΔE00", batch, whiskers=True),
        Panel(UNSEEN, "lights", "ΔE00", batch),
        Panel(f"{UNSEEN}, with set-up", "lights", "ΔE00", batch, whole=True),
        Panel("Unseen materials, the spectrum", "rms", "rms of reflectance", batch),
        Panel("Materials of the atlas itself, mean of five lights", "own_lights", "ΔE00", batch),
    )


def all_panels(chart: Chart) -> tuple[Panel, ...]:
    """Return the panels of all numbers of colours per call, those of one number together."""
    return tuple(panel for batch in chart.batches for panel in panels_of(batch))


MEASURED = "measured.csv"


def shipped_chart() -> Chart:
    """Return the chart of docs/chart.md, which is part of the package."""
    return parse_chart(files("uplift.lab.chart").joinpath(MEASURED).read_text(encoding="utf-8"), MEASURED)


@dataclass(frozen=True)
class Requirement:
    """Limits for time and error; at least one is required.

    ``time_ns``: largest CPU time per RGB, in ns.
    ``delta_e``: largest mean ΔE00.
    ``light``: light of the ΔE00, by default all lights of the chart; the illuminant D65 stands for round trips.
    ``own``: whether the ΔE00 is of materials of the atlas itself, not of unseen ones.

    Raises `OptionError`, `UnknownNameError`.
    """

    time_ns: float | None = None
    delta_e: float | None = None
    light: str | None = None
    own: bool = False

    def __post_init__(self) -> None:
        limits = {"time_ns": self.time_ns, "delta_e": self.delta_e}
        if all(limit is None for limit in limits.values()):
            raise OptionError("time_ns or delta_e is required", code="no-requirements", hint="give one or both")
        for name, limit in limits.items():
            if limit is not None and not 0 < limit < float("inf"):
                raise OptionError(f"{name} must be a positive number, got {limit:g}", code="limit-not-positive")
        if self.light not in (None, DEFAULT_ILLUMINANT, *CHART_LIGHTS):
            raise unknown_name(str(self.light), (DEFAULT_ILLUMINANT, *CHART_LIGHTS), "light")

    @property
    def error(self) -> str:
        """Return the name of the error in `MethodResult.numbers`."""
        if self.light == DEFAULT_ILLUMINANT:
            return "round_trip_mean"
        return f"{'own_' if self.own else ''}{self.light or 'lights'}_mean"

    @property
    def description(self) -> str:
        """Return the conditions of the error as text."""
        if self.light == DEFAULT_ILLUMINANT:
            return "of the round trip"
        lights = f"under {self.light}" if self.light else f"under {', '.join(CHART_LIGHTS)}"
        return f"{lights}, for {'materials of the atlas' if self.own else 'unseen materials'}"


def recommend_cube(chart: Chart, requirement: Requirement) -> MethodResult:
    """Choose a cube: the fastest that is accurate enough or, without a limit for the error, the most accurate in time.

    Raises `OptionError`.
    """
    cubes = [
        result for result in chart.measured if result.build and {"time_ns", requirement.error} <= result.numbers.keys()
    ]
    if not cubes:
        raise OptionError(
            f"the chart has no cube with {requirement.error}",
            code="chart-without-cubes",
            hint="measure one with uplift.lab.chart.measure",
        )

    def time(result: MethodResult) -> float:
        return result.numbers["time_ns"]

    def error(result: MethodResult) -> float:
        return result.numbers[requirement.error]

    fast = [cube for cube in cubes if requirement.time_ns is None or time(cube) <= requirement.time_ns]
    if not fast:
        fastest = min(cubes, key=time)
        raise OptionError(
            f"no cube takes at most {format_time(requirement.time_ns or 0)} per RGB",
            code="requirements-not-met",
            hint=f"the fastest, {fastest.method}, takes {format_time(time(fastest))}",
        )
    if requirement.delta_e is None:
        smallest = min(map(error, fast))
        return min((cube for cube in fast if CLEAR_RATIO * error(cube) <= smallest), key=time)
    sufficient = [cube for cube in fast if error(cube) <= requirement.delta_e]
    if not sufficient:
        best = min(fast, key=error)
        raise OptionError(
            f"no cube has at most ΔE00 {requirement.delta_e:g} {requirement.description}",
            code="requirements-not-met",
            hint=f"the most accurate, {best.method}, has {format_error(error(best))}",
        )
    return min(sufficient, key=time)
