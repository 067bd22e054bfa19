"""A chart as rows of numbers, and as a CSV file."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from enum import StrEnum

from uplift.common.csv import csv_text
from uplift.common.errors import ChartFileError
from uplift.common.files import read_bytes
from uplift.common.text import format_value, parse_float, shorten

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

    Parameters
    ----------
    method, title, label, family, source, mode, dtype, build, note : str
        As in `Method` and `Family`. The field `ask` is ``Method.call``.
    state : State
        Whether the method was measured.
    why : str
        The reason if it was not.
    numbers : mapping of str to float
        ``bytes``; CPU seconds ``build_s``, ``load_s`` and ``setup_s``, their sum; ``ns_N`` per RGB with N colours per
        call, see `uplift.lab.chart.timing.call_times`; ``time_ns``, that of the recommendation. Errors ``round_trip``
        (judged at 1 nm), ``coarse_round_trip`` (with the tables of cubes), of every light, ``lights`` (their mean) and
        ``rms``, and prefixed by ``own_`` those at entries that cubes were built from, each with ``_mean``, ``_p99`` and
        ``_max``. Sizes ``round_trip_colours``, ``unseen_spectra`` and ``own_spectra`` of the test set.
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

    Parameters
    ----------
    facts : mapping of str to str
        Machine, versions and test set; see `FACTS`.
    results : tuple of MethodResult
        The results.
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
    """Convert a chart to CSV.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    str
        One line per method, numbers with six digits.
    """
    names = list(dict.fromkeys(name for result in chart.results for name in result.numbers))
    facts = [chart.facts.get(name, "") for name in FACTS]
    rows = []
    for result in chart.results:
        numbers = (f"{result.numbers[name]:.6g}" if name in result.numbers else "" for name in names)
        rows.append([*(getattr(result, name) for name in TEXTS), *numbers, *facts])
    return csv_text([*TEXTS, *names, *FACTS], rows)


def read_chart(path: str | os.PathLike[str]) -> Chart:
    """Read the CSV file of a chart.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    Chart
        The chart.

    Raises
    ------
    ChartFileError
        If the file cannot be read or is not a valid chart.
    """
    data = read_bytes(path, ChartFileError, limit=MAX_BYTES, hint=HINT)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _chart_error(path, "not a UTF-8 text file", "file-unreadable") from error
    return parse_chart(text, path)


def parse_chart(text: str, path: str | os.PathLike[str]) -> Chart:
    """Parse the text of a chart's CSV file.

    Parameters
    ----------
    text : str
        The text.
    path : path-like
        The file, for error messages.

    Returns
    -------
    Chart
        The chart.

    Raises
    ------
    ChartFileError
        If the text is not a valid chart.
    """
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
