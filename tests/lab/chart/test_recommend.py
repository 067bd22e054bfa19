"""Recommendation of a cube."""

from __future__ import annotations

import shlex

import click
import pytest
from uplift_cli.main import main

from tests.helpers import raises
from uplift.common.errors import OptionError, UnknownNameError
from uplift.lab.chart.table import Requirement, recommend_cube, shipped_chart


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


def test_conditions_are_described():
    assert Requirement(delta_e=1, light="A").description == "under A, for unseen materials"
    assert Requirement(delta_e=1, light="D65").description == "of the round trip"


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
