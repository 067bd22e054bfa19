"""Texts of numbers."""

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
    ("write", "texts"),
    [
        (
            format_scientific,
            {0: "0", 1.6e-5: "1.6\u00a0×\u00a010⁻⁵", 0.0271: "0.0271", 506.2: "506", np.nan: "not finite"},
        ),
        (format_power_of_ten, {1e-9: "10⁻⁹", 1.0: "10⁰"}),
        (format_time, {0.4: "0.4 ns", 70: "70 ns", 999.6: "1 µs", 4217: "4.22 µs", 1e9: "1 s"}),
        (format_size, {560: "560 B", 999.9: "1 kB", 18.9e6: "18.9 MB"}),
        (format_error, {0: "< 0.0001", 9e-5: "< 0.0001", 1e-4: "0.0001", 0.01: "0.01"}),
        (format_build_time, {None: "", 0: "nothing", 1.5: "1.5 s"}),
    ],
)
def test_numbers_have_few_digits_and_the_largest_unit(write, texts):
    for value, text in texts.items():
        assert write(value) == text
