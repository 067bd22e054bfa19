"""CSV files of charts, Pareto fronts against their definition, and the recommendation of a cube."""

from __future__ import annotations

import shlex
from itertools import pairwise

import click
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from uplift_cli.main import main

from tests.helpers import raises
from uplift.common.errors import ChartFileError, OptionError, UnknownNameError
from uplift.lab.chart.table import (
    CLEAR_RATIO,
    MIN_ERROR,
    Requirement,
    State,
    chart_csv,
    panels_of,
    parse_chart,
    read_chart,
    recommend_cube,
    shipped_chart,
)


def test_csv_round_trip(row_of, chart_of, tmp_path):
    chart = chart_of(
        row_of("quick, or 'not'", 12.3456, 1e-7, note="a note\nof two lines"),
        row_of("broken", 1, 1, state=State.BROKEN, why="NaN", numbers={}),
    )
    (tmp_path / "chart.csv").write_text(chart_csv(chart), encoding="utf-8")
    again = read_chart(tmp_path / "chart.csv")
    assert again.facts == chart.facts
    assert chart_csv(again) == chart_csv(chart)
    first, second = again.results
    assert first.numbers == pytest.approx(chart.results[0].numbers, rel=1e-5)
    assert (first.method, first.note) == ("quick, or 'not'", "a note\nof two lines")
    assert (second.state, second.why, second.numbers) == (State.BROKEN, "NaN", {})


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (lambda text: "", "not-a-chart"),
        (lambda text: "name,r,g,b\nred,1,0,0\n", "not-a-chart"),
        (lambda text: text.splitlines()[0] + "\n", "chart-without-methods"),
        (lambda text: text.replace("measured", "excellent"), "invalid-chart"),
        (lambda text: text.replace("12.5", "fast"), "invalid-chart"),
        (lambda text: text.replace("12.5", "nan"), "invalid-chart"),
        (lambda text: text.replace("unseen_spectra", "seen_spectra"), "invalid-chart"),
        (lambda text: text.rstrip()[:-30], "invalid-chart"),
        (lambda text: text.rstrip() + ",one,more\n", "invalid-chart"),
    ],
)
def test_invalid_table_is_an_error(row_of, chart_of, spoil, code):
    text = chart_csv(chart_of(row_of("one", 12.5, 1)))
    assert parse_chart(text, "chart.csv").results
    with raises(ChartFileError, code) as caught:
        parse_chart(spoil(text), "chart.csv")
    assert caught.value.path == "chart.csv"


def test_unreadable_file_is_an_error(tmp_path):
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    for name, code in (
        ("none.csv", "file-not-found"),
        ("", "not-a-regular-file"),
        ("bytes.csv", "file-unreadable"),
    ):
        with raises(ChartFileError, code):
            read_chart(tmp_path / name)


PANELS = panels_of(64)
ROUND_TRIP = PANELS[0]
times, errors = st.sampled_from([1.0, 10.0, 11.0, 100.0, 1e5]), st.floats(1e-6, 10)


@given(st.lists(st.tuples(times, errors), min_size=1, max_size=12))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_front_is_clearly_more_accurate_than_all_faster_methods(row_of, chart_of, points):
    rows = [row_of(str(number), time, error) for number, (time, error) in enumerate(points)]
    front = ROUND_TRIP.front(chart_of(*rows))
    points_of = {row: (row.numbers["ns_64"], max(row.numbers["round_trip_mean"], MIN_ERROR)) for row in rows}
    for one, other in pairwise(front):
        assert points_of[one][0] < points_of[other][0]
        assert points_of[other][1] < CLEAR_RATIO * points_of[one][1]
    for row in set(rows) - set(front):
        time, error = points_of[row]
        assert any(points_of[other][0] <= time and CLEAR_RATIO * points_of[other][1] <= error for other in front)


def test_ties_go_to_the_more_accurate_and_1_percent_is_noise(row_of, chart_of):
    slow, near, same = row_of("slow", 20, 0.5), row_of("near", 10, 0.501), row_of("same", 10, 0.9)
    assert ROUND_TRIP.front(chart_of(slow, same, near)) == (near,)


def test_invisible_errors_are_equal(row_of, chart_of):
    exact, enough = row_of("exact", 20, 1e-9), row_of("enough", 10, 5e-5)
    assert ROUND_TRIP.front(chart_of(exact, enough)) == (enough,)


def test_method_without_a_number_is_not_drawn(row_of, chart_of):
    timed, other = row_of("timed", 1, 1.0), row_of("other", 1, 0.5)
    numbers = {key: value for key, value in other.numbers.items() if not key.startswith("ns_64")}
    other = row_of("other", 1, 0.5, numbers=numbers)
    assert ROUND_TRIP.point(other) is None
    assert ROUND_TRIP.front(chart_of(timed, other)) == (timed,)


def test_set_up_is_part_of_the_time_of_a_call(row_of, chart_of):
    row = row_of("one", 1000, 1.0)
    each, whole = (panel for panel in PANELS if panel.error == "lights")
    assert each.point(row) == (1000, 1)
    assert whole.point(row) == (1.5e9 + 64 * 1000, 1)
    assert whole.labels(row) == ("1.5 s", "1")


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.title)
def test_empty_chart_has_an_empty_front(chart_of, panel):
    assert panel.front(chart_of()) == ()


@pytest.fixture
def chart(row_of, chart_of):
    return chart_of(
        row_of("peer", 1, 1e-3),
        row_of("rough", 50, 2.0, build="uplift build --dim 8"),
        row_of("good", 90, 0.5, build="uplift build --dim 32"),
        row_of("better", 900, 0.2, build="uplift build --dim 64"),
        row_of("no better", 9000, 0.199, build="uplift build --dim 128"),
    )


@pytest.mark.parametrize(
    ("requirement", "name"),
    [
        (Requirement(time_ns=100), "good"),
        (Requirement(time_ns=60), "rough"),
        (Requirement(time_ns=1e6, light="FL11"), "better"),
        (Requirement(delta_e=0.5, light="FL11"), "good"),
        (Requirement(delta_e=0.3, light="D65"), "better"),
        (Requirement(delta_e=10, own=True), "rough"),
        (Requirement(time_ns=100, delta_e=1), "good"),
    ],
)
def test_fastest_accurate_enough_or_most_accurate_in_time(chart, requirement, name):
    assert recommend_cube(chart, requirement).method == name


@pytest.mark.parametrize(
    ("requirement", "closest"),
    [
        (Requirement(time_ns=10), "the fastest, rough, takes 50 ns"),
        (
            Requirement(delta_e=0.1, light="A"),
            "the most accurate, no better, has 0.199",
        ),
        (
            Requirement(delta_e=0.3, time_ns=100),
            "the most accurate, good, has 0.5",
        ),
    ],
)
def test_unmet_requirement_names_the_closest_cube(chart, requirement, closest):
    with raises(OptionError, "requirements-not-met") as caught:
        recommend_cube(chart, requirement)
    assert caught.value.hint == closest


def test_chart_without_cubes_is_an_error(row_of, chart_of):
    with raises(OptionError, "chart-without-cubes"):
        recommend_cube(chart_of(row_of("peer", 1, 1)), Requirement(time_ns=100))


@pytest.mark.parametrize("limit", [0, -1, float("nan"), float("inf")])
def test_limits_must_be_positive(limit):
    for field in ("time_ns", "delta_e"):
        with raises(OptionError, "limit-not-positive"):
            Requirement(**{field: limit})


def test_limit_is_required_and_light_must_be_in_the_chart():
    with raises(OptionError, "no-requirements"):
        Requirement()
    with raises(UnknownNameError, "unknown-light") as caught:
        Requirement(delta_e=1, light="FL111")
    assert "'FL11'" in caught.value.hint


def test_recommendation_of_the_shipped_chart_is_a_valid_command():
    found = recommend_cube(shipped_chart(), Requirement(time_ns=1e5))
    assert found.numbers["time_ns"] <= 1e5
    name, *arguments = shlex.split(found.build)[1:]
    with click.Context(main, **main.context_settings) as context:
        main.get_command(context, name).make_context(name, arguments, parent=context)
