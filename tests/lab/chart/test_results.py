"""CSV files of charts, the recommendation of a cube, pictures and pages."""

import itertools
import re
from collections import Counter

import pytest

from tests.browsing import check_page
from tests.helpers import raises
from tests.lab.chart.conftest import chart_of, row_of
from tests.pages import Page, markers, tooltips
from uplift.common.errors import ChartFileError, OptionError
from uplift.lab.chart.picture import render_chart
from uplift.lab.chart.recommendation import Requirement, recommend_cube
from uplift.lab.chart.results import (
    State,
    chart_csv,
    criteria,
    read_chart,
)


def test_csv_round_trip(tmp_path):
    chart = chart_of(
        row_of("quick, or 'not'", 12.3456, 1e-7, note="a note\nof two lines"),
        row_of("broken", 1, 1, state=State.BROKEN, why="NaN", numbers={}),
    )
    (tmp_path / "chart.csv").write_text(chart_csv(chart), encoding="utf-8")
    again = read_chart(tmp_path / "chart.csv")
    assert chart_csv(again) == chart_csv(chart)
    assert again.facts == chart.facts
    first, second = again.results
    assert first.numbers == pytest.approx(chart.results[0].numbers, rel=1e-5)
    assert first.note == "a note\nof two lines"
    assert second.numbers == {}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (r"(?s).*", ""),
        ("measured", "excellent"),
        ("12.5", "fast"),
        ("12.5", "nan"),
        ("12.5", "-1"),
        ("unseen_spectra", "seen_spectra"),
        ("$", ",one,more"),
        ("$", "\udcff"),
    ],
)
def test_invalid_table_is_an_error(tmp_path, old, new):
    text = chart_csv(chart_of(row_of("one", 12.5, 1))).rstrip()
    file = tmp_path / "chart.csv"
    file.write_bytes(re.sub(old, new, text).encode(errors="surrogateescape"))
    with raises(ChartFileError, "chart-file") as caught:
        read_chart(file)
    assert caught.value.path == file


CUBES = chart_of(
    row_of("peer", 1, 1e-3),
    row_of("rough", 50, 2.0, build="build"),
    row_of("good", 90, 0.5, build="build"),
    row_of("better", 900, 0.2, build="build"),
    row_of("no better", 9000, 0.199, build="build"),
    row_of("atlas", 10, 3.0, build="build --atlas"),
    row_of("small", 900, 0.9, memory=1.0, build="build"),
)


@pytest.mark.parametrize(
    ("requirement", "name"),
    [
        (Requirement(time_ns=100), "good"),
        (Requirement(delta_e=0.5, light="FL11"), "good"),
        (Requirement(delta_e=0.3, light="D65"), "better"),
        (Requirement(delta_e=10, plain=True), "rough"),
        (Requirement(delta_e=1, plain=True, smallest=True), "small"),
        (Requirement(time_ns=100, delta_e=1), "good"),
    ],
)
def test_fastest_accurate_enough_or_most_accurate_in_time(requirement, name):
    assert recommend_cube(CUBES, requirement).method == name


@pytest.mark.parametrize(
    ("requirement", "closest"),
    [
        (Requirement(time_ns=9), "the fastest, atlas, takes 10 ns"),
        (Requirement(delta_e=0.3, time_ns=100), "the most accurate, good, has 0.5"),
    ],
)
def test_unmet_requirement_names_the_closest_cube(requirement, closest):
    with raises(OptionError, "requirements-not-met") as caught:
        recommend_cube(CUBES, requirement)
    assert caught.value.hint == closest


HOSTILE = "</script><b>$x</b>"


def test_page_has_markers_of_measured_methods_fits_and_is_accessible(tmp_path):
    chart = chart_of(
        row_of(HOSTILE, 80, 0.4),
        row_of("9 · 32³", 900, 0.02, build="uplift build", family="unknown"),
        row_of("wrong", 1, 1e-9, state=State.BROKEN, why=HOSTILE, numbers={}),
    )
    text = render_chart(chart)
    panels = range(len(chart.batches) * len(criteria(64)))
    assert markers(text) == Counter(itertools.product(panels, range(2)))
    assert HOSTILE not in text
    (row,) = Page(text).table("method", "state", "reason")
    assert [cell.text for cell in row] == ["wrong", "broken", HOSTILE]
    first, *_ = tooltips(text)
    assert first["title"] == HOSTILE
    assert ["memory", "10 kB"] in first["lines"]
    check_page(text, tmp_path)
