"""Texts of numbers."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.viz.format import (
    format_build_time,
    format_error,
    format_power_of_ten,
    format_scientific,
    format_size,
    format_time,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (1.6e-5, "1.6\u00a0×\u00a010⁻⁵"),
        (0.0271, "0.0271"),
        (2.7, "2.70"),
        (506.2, "506"),
        (np.nan, "not finite"),
    ],
)
def test_scientific_notation(value, text):
    assert format_scientific(value) == text


def test_powers_of_ten():
    assert (format_power_of_ten(1e-9), format_power_of_ten(1.0)) == ("10⁻⁹", "10⁰")


@pytest.mark.parametrize(
    ("ns", "text"), [(0.4, "0.4 ns"), (70, "70 ns"), (999.6, "1 µs"), (4217, "4.22 µs"), (1e9, "1 s")]
)
def test_times_have_the_largest_unit(ns, text):
    assert format_time(ns) == text


def test_sizes_have_decimal_units():
    assert [format_size(size) for size in (560, 999.9, 18.9e6)] == ["560 B", "1 kB", "18.9 MB"]


def test_invisible_errors_are_not_distinguished():
    assert [format_error(error) for error in (0, 9e-5, 1e-4, 0.01)] == [
        "< 0.0001",
        "< 0.0001",
        "0.0001",
        "0.01",
    ]


def test_build_times_distinguish_nothing_from_unknown():
    assert [format_build_time(seconds) for seconds in (None, 0, 1.5)] == ["", "nothing", "1.5 s"]
