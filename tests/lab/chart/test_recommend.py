"""What to build, from what was measured."""

from __future__ import annotations

import shlex

import click
import pytest
from uplift_cli.main import main

from uplift.common.errors import OptionError, UnknownNameError
from uplift.lab.chart.recommend import Requirement, recommend, shipped


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
    ("wish", "name"),
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
def test_the_quickest_that_is_near_enough_or_the_nearest_that_is_quick_enough(chart, wish, name):
    assert recommend(chart, wish).method == name


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        (Requirement(time_ns=10), "no cube answers in 10 ns per RGB; the quickest, rough, takes 50 ns"),
        (
            Requirement(delta_e=0.1, light="A"),
            "within ΔE00 0.1 under A, for unseen materials; the nearest, no better, has 0.199",
        ),
        (Requirement(delta_e=0.3, time_ns=100), "the nearest, good, has 0.5"),
    ],
)
def test_what_cannot_be_had_is_refused_with_what_comes_closest(chart, wish, message):
    with pytest.raises(OptionError, match=message):
        recommend(chart, wish)


def test_a_chart_without_cubes_has_nothing_to_recommend(row_of, chart_of):
    with pytest.raises(OptionError, match="has no cube"):
        recommend(chart_of(row_of("peer", 1, 1)), Requirement(time_ns=100))


@pytest.mark.parametrize("limit", [0, -1, float("nan"), float("inf")])
def test_limits_are_positive_numbers(limit):
    for field in ("time_ns", "delta_e"):
        with pytest.raises(OptionError, match="a limit is no positive number"):
            Requirement(**{field: limit})


def test_a_wish_needs_a_limit_and_a_light_of_the_chart():
    with pytest.raises(OptionError, match="nothing is wished for"):
        Requirement()
    with pytest.raises(UnknownNameError, match="did you mean 'FL11'"):
        Requirement(delta_e=1, light="FL111")


def test_the_shipped_chart_recommends_what_can_be_built():
    found = recommend(shipped(), Requirement(time_ns=1e5))
    assert found.numbers["time_ns"] <= 1e5
    name, *arguments = shlex.split(found.build)[1:]
    with click.Context(main, **main.context_settings) as context:
        main.get_command(context, name).make_context(name, arguments, parent=context)
