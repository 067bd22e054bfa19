"""Pareto fronts against their definition."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from uplift.lab.chart.panels import CLEAR_RATIO, MIN_ERROR, PANELS

ROUND_TRIP = PANELS[0]
times, errors = st.sampled_from([1.0, 10.0, 11.0, 100.0, 1e5]), st.floats(1e-6, 10)


@given(st.lists(st.tuples(times, errors), min_size=1, max_size=12))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_front_is_clearly_more_accurate_than_all_faster_methods(row_of, chart_of, points):
    rows = [row_of(str(number), time, error) for number, (time, error) in enumerate(points)]
    front = ROUND_TRIP.front(chart_of(*rows))
    points_of = {
        row: (row.numbers["time_ns"], max(row.numbers["round_trip_mean"], MIN_ERROR)) for row in rows
    }
    for one, other in pairwise(front):
        assert points_of[one][0] < points_of[other][0]
        assert points_of[other][1] < CLEAR_RATIO * points_of[one][1]
    for row in set(rows) - set(front):
        time, error = points_of[row]
        assert any(
            points_of[other][0] <= time and CLEAR_RATIO * points_of[other][1] <= error for other in front
        )


def test_ties_go_to_the_more_accurate_and_1_percent_is_noise(row_of, chart_of):
    slow, near, same = row_of("slow", 20, 0.5), row_of("near", 10, 0.501), row_of("same", 10, 0.9)
    assert ROUND_TRIP.front(chart_of(slow, same, near)) == (near,)


def test_invisible_errors_are_equal(row_of, chart_of):
    exact, enough = row_of("exact", 20, 1e-9), row_of("enough", 10, 5e-5)
    assert ROUND_TRIP.front(chart_of(exact, enough)) == (enough,)


def test_method_without_a_number_is_not_drawn(row_of, chart_of):
    built, given = row_of("built", 1, 1.0), row_of("given", 1, 0.5)
    numbers = {key: value for key, value in given.numbers.items() if key != "build_s"}
    elsewhere = row_of("given", 1, 0.5, numbers=numbers)
    building = PANELS[-1]
    assert building.time == "build_s"
    assert building.point(elsewhere) is None
    assert building.front(chart_of(built, elsewhere)) == (built,)
    assert building.labels(built) == ("1 s", "1")


def test_panels_cover_all_errors():
    assert [panel.error for panel in PANELS] == [
        "round_trip", "A", "FL2", "FL7", "FL11", "LED-B3", "rms", "own_lights", "lights",
    ]  # fmt: skip


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.title)
def test_empty_chart_has_an_empty_front(chart_of, panel):
    assert panel.front(chart_of()) == ()
