"""Fuzz target: the tables of charts, with mutated cells."""

from __future__ import annotations

import csv
import functools
import io
from pathlib import Path

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from uplift.lab.chart.page import _tooltip
from uplift.lab.chart.panels import all_panels
from uplift.lab.chart.recommend import Requirement, recommend_cube
from uplift.lab.chart.table import chart_csv, read_chart

CELLS = (
    "",
    " ",
    "nan",
    "inf",
    "-1",
    "1e308",
    "1e30",
    "5e-324",
    "1_0",
    "٣",
    "measured",
    "broken",
    "x" * 200_000,
)
TOKENS = (
    b",",
    b"\n",
    b'"',
    b'""',
    b"\0",
    b"\xff",
    b"measured",
    b"not installed",
    b"_mean",
    b"_p99",
    *NUMBERS,
)


@functools.cache
def _rows() -> list[list[str]]:
    """Return the heading, two other methods and three cubes of the shipped table."""
    path = ROOT / "uplift" / "lab" / "chart" / "measured.csv"
    heading, *rows = csv.reader(path.read_text(encoding="utf-8").splitlines())
    is_cube = [bool(row[heading.index("build")]) for row in rows]
    first = is_cube.index(True)
    return [heading, *rows[:2], *rows[first : first + 3]]


def _generate(random: Random, path: Path) -> None:
    rows = [list(row) for row in _rows()]
    for _ in range(int(random.integers(3))):
        row = rows[random.integers(len(rows))]
        row[random.integers(len(row))] = CELLS[random.integers(len(CELLS))]
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    content = text.getvalue().encode()
    path.write_bytes(mutate(content, random, TOKENS) if random.random() < 0.3 else content)


def _use(path: Path) -> None:
    """Read the chart, write it again, and compute all that its pictures and pages show."""
    chart = read_chart(path)
    chart_csv(chart)
    for panel in all_panels(chart):
        for result in panel.front(chart):
            panel.labels(result)
            if panel.whiskers:
                panel.whisker(result)
    for result in chart.results:
        _tooltip(result)
    recommend_cube(chart, Requirement(time_ns=1e5))


TARGET = Target("chart table", _generate, _use)
