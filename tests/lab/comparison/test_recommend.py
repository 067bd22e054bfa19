"""Recommendation of a representation."""

from __future__ import annotations

import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.lab.comparison.compare import Comparison, RepresentationResult, Statistics, cheapest, most_accurate
from uplift.lab.timing import Spread


def row(name, high, floats, light_floats=8.0, ns=5.0, lights="smooth"):
    found = Statistics(high / 2, 0.1, high / 2, 0.0, high / 3, high / 1.5, high)
    return RepresentationResult(name, "made up", lights, found, floats, light_floats, Spread(ns, ns, ns, 3))


ROWS = (
    row("near", 0.2, 32.0),
    row("even", 0.8, 9.0, 12.0, 30.0),
    row("rough", 0.9, 9.0, 12.0, 3.0),
    row("tabled", 0.7, 9.0, 81.0, 1.0),
    row("far", 1.1, 3.0),
    row("other", 0.1, 1.0, lights="spiky"),
)
FOUND = Comparison({}, {"smooth": "smooth lights (A)", "spiky": "spiky lights (FL2)"}, ROWS)


@pytest.mark.parametrize(
    ("target", "name"),
    [(2.0, "far"), (1.1, "far"), (1.0, "even"), (0.9, "even"), (0.75, "tabled"), (0.5, "near")],
)
def test_surfaces_count_first_then_lights_then_errors(target, name):
    assert cheapest(FOUND, "smooth", target).name == name


def test_sets_of_lights_are_independent():
    assert cheapest(FOUND, "spiky", 0.5).name == "other"


def test_no_representation_is_accurate_enough():
    assert cheapest(FOUND, "smooth", 0.1) is None
    assert most_accurate(FOUND, "smooth").name == "near"


def test_cheapest_of_a_measured_comparison_is_within_the_target(found):
    best = cheapest(found, "spiky", 2.5)
    assert best is not None
    assert best.statistics.q97_5 <= 2.5
    for other in found.of("spiky"):
        assert other.statistics.q97_5 > 2.5 or other.floats >= best.floats


@pytest.mark.parametrize("target", [0, -1, float("nan"), float("inf")])
def test_target_must_be_positive(target):
    with raises(OptionError, "target-not-positive"):
        cheapest(FOUND, "smooth", target)
