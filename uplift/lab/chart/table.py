"""A chart as rows of numbers, and as one CSV file that holds all there is to know."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from pathlib import Path

from uplift.common.csv import csv_text
from uplift.common.errors import ChartFileError

FACTS = ("machine", "versions", "commit", "colours", "spectra", "effort")
"""What holds for all rows: each a column."""


class State(StrEnum):
    """What became of a method: only what is measured is drawn."""

    MEASURED = "measured"
    BROKEN = "broken"
    MISSING = "not installed"


@dataclass(frozen=True, eq=False)
class MethodResult:
    """A method and what was found of it.

    ``why`` tells what is broken or missing. ``numbers``: ``bytes``, ``build_s``; ``batch_ns`` and ``single_ns`` per
    RGB, each with ``_least``, ``_most``, ``_runs``, ``_colours``; ``time_ns``, the batch's or, without one, the single;
    errors ``round_trip``, every light's, ``lights`` (their mean) and ``rms``, and with ``own_`` before them those at
    entries that cubes were built from, each with ``_mean``, ``_p99``, ``_max``; ``round_trip_colours``,
    ``unseen_spectra``, ``own_spectra`` that were asked for.
    """

    method: str
    title: str
    label: str
    family: str
    source: str
    mode: str
    build: str
    ask: str
    note: str
    state: State
    why: str
    numbers: Mapping[str, float]


@dataclass(frozen=True)
class Chart:
    """Rows, and the ``facts`` that hold for all of them."""

    facts: Mapping[str, str]
    rows: tuple[MethodResult, ...]

    @property
    def measured(self) -> tuple[MethodResult, ...]:
        """Those that are drawn."""
        return tuple(row for row in self.rows if row.state == State.MEASURED)


TEXTS = tuple(field.name for field in fields(MethodResult) if field.name != "numbers")


def chart_csv(chart: Chart) -> str:
    """A line a method; numbers to six digits."""
    names = list(dict.fromkeys(name for row in chart.rows for name in row.numbers))
    facts = [chart.facts.get(name, "") for name in FACTS]
    rows = []
    for row in chart.rows:
        numbers = (f"{row.numbers[name]:.6g}" if name in row.numbers else "" for name in names)
        rows.append([*(getattr(row, name) for name in TEXTS), *numbers, *facts])
    return csv_text([*TEXTS, *names, *FACTS], rows)


def read_chart(path: str | os.PathLike[str]) -> Chart:
    """The chart that a CSV file holds. Raises `ChartFileError`."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise _unreadable(path, "cannot be read") from error
    return parse_chart(text, path)


def parse_chart(text: str, path: str | os.PathLike[str]) -> Chart:
    """The same from the text of ``path``. Raises `ChartFileError`."""
    reader = csv.DictReader(io.StringIO(text))
    if not {*TEXTS, *FACTS} <= set(reader.fieldnames or ()):
        raise _unreadable(path, "is no chart's table")
    try:
        lines = list(reader)
        rows = tuple(_row(line) for line in lines)
    except (ValueError, TypeError, csv.Error) as error:
        raise _unreadable(path, f"is broken: {error}") from error
    if not rows:
        raise _unreadable(path, "holds no methods")
    return Chart({name: lines[0][name] for name in FACTS}, rows)


def _row(line: dict[str, str]) -> MethodResult:
    if None in line or None in line.values():
        raise ValueError("a line is longer or shorter than the first")
    texts = {name: line[name] for name in TEXTS if name != "state"}
    numbers = {name: float(line[name]) for name in line if name not in (*TEXTS, *FACTS) and line[name]}
    if not all(map(math.isfinite, numbers.values())):
        raise ValueError(f"'{line['method']}' has a number that is none")
    return MethodResult(**texts, state=State(line["state"]), numbers=numbers)


def _unreadable(path: str | os.PathLike[str], problem: str) -> ChartFileError:
    return ChartFileError(problem, path=path, hint="name the CSV file that 'uplift chart' wrote")
