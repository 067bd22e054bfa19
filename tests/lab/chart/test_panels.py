"""Pareto fronts against their definition."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from uplift.lab.chart.table import CLEAR_RATIO, MIN_ERROR, all_panels, panels_of

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


def test_panels_of_each_number_of_colours(row_of, chart_of):
    assert [panel.error for panel in PANELS] == ["round_trip", "lights", "lights", "rms", "own_lights"]
    chart = chart_of(row_of("one", 1, 1.0))
    assert chart.batches == (1, 64)
    assert all_panels(chart) == (*panels_of(1), *panels_of(64))
    assert panels_of(1)[0].colours == "1 colour per call"
    assert panels_of(65_536)[0].colours == "65,536 colours per call"


def test_chart_without_measurements_has_no_panels(chart_of):
    assert all_panels(chart_of()) == ()


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.title)
def test_empty_chart_has_an_empty_front(chart_of, panel):
    assert panel.front(chart_of()) == ()
