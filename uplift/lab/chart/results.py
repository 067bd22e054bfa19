"""A chart as rows of numbers and as CSV, and its panels with Pareto fronts."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import ChartFileError
from uplift.common.files import read_bytes
from uplift.common.text import format_value, parse_float, pluralise, shorten
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.files.csv import csv_text, parse_csv
from uplift.extras.pages.pareto import pareto_front
from uplift.lab.description import Description

FACTS = ("machine", "versions", "commit", "colours", "spectra", "effort")
"""Columns with the same text in all rows."""
MAX_BYTES = 16 << 20
"""Largest file that is read."""
MAX_NUMBER = 1e30
SUMMARY: Mapping[str, Callable[[Array], Any]] = {
    "mean": np.mean,
    "p99": partial(np.quantile, q=0.99),
    "max": np.max,
}
"""Statistics of each error."""
ERRORS = ("round_trip", "coarse_round_trip", *CHART_LIGHTS, "lights", "rms")
OWN_ERRORS = tuple(f"own_{name}" for name in ERRORS[2:])
REQUIRED = {"bytes", "time_ns", "setup_s", "round_trip_colours", "unseen_spectra"}
REQUIRED |= set(map("_".join, product((*ERRORS, *OWN_ERRORS), SUMMARY)))
"""Numbers of every method that was measured."""
BATCH = re.compile(r"ns_([1-9]\d{0,8})")
"""Name of a time by the number of colours per call."""
REFERENCE = 65_536
MEASURED = Path(__file__).with_name("measured.csv")
"""The chart that is part of the package."""
HINT = "give the CSV file of a chart"


class State(StrEnum):
    """Whether a method was measured; only measured ones are drawn."""

    MEASURED = "measured"
    BROKEN = "broken"
    MISSING = "not installed"


@dataclass(frozen=True, eq=False, kw_only=True)
class MethodResult(Description):
    """Result of a method. The fields are the columns of the CSV file.

    ``numbers``: ``bytes``; CPU seconds ``build_s``, ``load_s`` and ``setup_s``, their
    sum; ``ns_N`` per RGB with N colours per call, see
    `uplift.lab.chart.call_times.call_times`; ``time_ns``, that of the recommendation.
    Errors ``round_trip`` (judged at 1 nm), ``coarse_round_trip`` (with the tables of
    cubes), of every light, ``lights`` (their mean) and ``rms``, and prefixed by
    ``own_`` those at entries that cubes were built from, each with ``_mean``, ``_p99``
    and ``_max``. Sizes ``round_trip_colours``, ``unseen_spectra`` and ``own_spectra``
    of the test set.
    """

    state: State
    why: str
    numbers: Mapping[str, float]


TEXTS = tuple(field.name for field in fields(MethodResult) if field.name != "numbers")


@dataclass(frozen=True)
class Chart:
    """Results of all methods, and ``facts`` about machine, versions and test set; see
    `FACTS`.
    """

    facts: Mapping[str, str]
    results: tuple[MethodResult, ...]

    @property
    def measured(self) -> tuple[MethodResult, ...]:
        """Return the results of the methods that were measured."""
        return tuple(
            result for result in self.results if result.state == State.MEASURED
        )

    @property
    def batches(self) -> tuple[int, ...]:
        """Return the numbers of colours per call that were timed, ascending."""
        names = set[str]().union(*(result.numbers for result in self.measured))
        matches = map(BATCH.fullmatch, names)
        return tuple(sorted(int(match[1]) for match in matches if match))


def chart_csv(chart: Chart) -> str:
    """Convert a chart to CSV."""
    of_results = (result.numbers for result in chart.results)
    names = dict.fromkeys(chain.from_iterable(of_results))
    columns = [*TEXTS, *names, *FACTS]
    rows = []
    for result in chart.results:
        numbers = {name: f"{value:.9g}" for name, value in result.numbers.items()}
        cells = vars(result) | numbers | dict(chart.facts)
        rows.append([cells.get(name, "") for name in columns])
    return csv_text(columns, rows)


def shipped_chart() -> Chart:
    """Return the chart of docs/speed.md, which is part of the package."""
    return read_chart(MEASURED)


def read_chart(path: StrPath) -> Chart:
    """Read the CSV file of a chart. Raises `ChartFileError`."""
    data = read_bytes(path, ChartFileError, limit=MAX_BYTES, hint=HINT)
    try:
        lines = parse_csv(data)
        if not lines:
            raise ValueError("it contains no methods")
        results = tuple(map(_result, lines))
    except ValueError as error:
        raise ChartFileError(
            f"is not the table of a chart: {error}", path=path, hint=HINT
        ) from error
    return Chart({name: lines[0][name] for name in FACTS}, results)


def _result(line: dict[str, str]) -> MethodResult:
    if not {*TEXTS, *FACTS} <= line.keys():
        raise ValueError("columns are missing")
    texts: dict[str, Any] = {name: line[name] for name in TEXTS}
    numbers = {}
    required = set(REQUIRED)
    for name, text in line.items():
        if name not in (*TEXTS, *FACTS) and text.strip():
            numbers[name] = _number(name, text)
            if BATCH.fullmatch(name):
                required.add(f"{name}_colours")
    state = State(line["state"])
    if state == State.MEASURED and (missing := required - numbers.keys()):
        raise ValueError(f"{format_value(line['method'])} has no {min(missing)}")
    return MethodResult(**texts | {"state": state}, numbers=numbers)


def _number(name: str, text: str) -> float:
    value = parse_float(text.strip())
    if not 0 <= value <= MAX_NUMBER:
        raise ValueError(
            f"{shorten(name)} must be in [0, {MAX_NUMBER:g}], got {format_value(text)}"
        )
    return value


def reference_batch(batches: Sequence[int]) -> int:
    """Return the colours per call of the time by which cubes are recommended, and which
    the page shows at first: at most `REFERENCE`, if there are so few.
    """
    few = [batch for batch in batches if batch <= REFERENCE]
    return max(few, default=min(batches, default=0))


MIN_TIME = 1.0
"""Left end of the time axes in ns."""
MIN_ERROR = 1e-4
"""Smaller errors are not visible and are drawn here, so that the faster of two such
methods is on the front.
"""


@dataclass(frozen=True)
class Criterion:
    """An error over a time: what a panel compares.

    ``error``: name of the error in `MethodResult.numbers`, without ``_mean``; the mean
    is drawn. ``batch``: number of colours per call. ``whole``: whether time is that of
    all colours of the batch and of the set-up, instead of that per RGB.
    """

    title: str
    error: str
    unit: str
    batch: int
    whole: bool = False

    @property
    def colours(self) -> str:
        """Return the number of colours per call as text."""
        return f"{pluralise(self.batch, 'colour')} per call"

    @property
    def axis(self) -> str:
        """Return the label of the time axis."""
        return "CPU time of a call, with set-up" if self.whole else "CPU time per RGB"

    def points(
        self, results: Iterable[MethodResult]
    ) -> dict[MethodResult, tuple[float, float]]:
        """Return time in ns and mean error, as they are drawn, of the results that have
        both.
        """
        points = {}
        for result in results:
            time = result.numbers.get(f"ns_{self.batch}")
            error = result.numbers.get(f"{self.error}_mean")
            if time is not None and error is not None:
                if self.whole:
                    time = 1e9 * result.numbers["setup_s"] + self.batch * time
                points[result] = max(time, MIN_TIME), max(error, MIN_ERROR)
        return points

    def front(
        self, results: Iterable[MethodResult]
    ) -> dict[MethodResult, tuple[float, float]]:
        """Return the points of the Pareto front, fastest first: each is clearly more
        accurate than all faster methods.
        """
        points = list(self.points(results).items())
        front = pareto_front([point for _, point in points])
        return dict(points[row] for row in front)


UNSEEN = "Unseen materials, mean of five lights"


def criteria(batch: int) -> tuple[Criterion, ...]:
    """Return what is compared for a number of colours per call."""
    return (
        Criterion("Round trip, judged at 1 nm", "round_trip", "ΔE00", batch),
        Criterion(UNSEEN, "lights", "ΔE00", batch),
        Criterion(f"{UNSEEN}, with set-up", "lights", "ΔE00", batch, whole=True),
        Criterion("Unseen materials, the spectrum", "rms", "rms of reflectance", batch),
        Criterion(
            "Materials of the atlas itself, mean of five lights",
            "own_lights",
            "ΔE00",
            batch,
        ),
    )
